#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace knead::iges {

/// The directory number at this place of an entity's parameters, without its sign; 0: none.
[[nodiscard]] int pointer_at(const std::vector<std::string>& values, std::size_t k);

/// The entities that one of this type is made of, by directory number: curves, points and
/// directions of surfaces, surfaces and boundaries of faces, the definition that an instance (408)
/// places. Types that are not known are made of none. May have numbers that are no entities.
[[nodiscard]] std::vector<int> parts_of(int type, const std::vector<std::string>& values);

}  // namespace knead::iges
