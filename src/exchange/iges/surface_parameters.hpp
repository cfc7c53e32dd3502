#pragma once

#include <string>
#include <vector>

#include "file.hpp"
#include "knead/spline/spline.hpp"

namespace knead::iges {

/// The parameters that an entity has as a B-spline surface (128), the first of which is its type,
/// with the pointers to associativities and properties behind what describes it.
///
/// A surface of another type (108, 114, 118, 120, 122, 190 to 198) becomes a 128; of a 128, numbers
/// that stay the same keep their text. Points go back through its transformation matrix. \param
/// surface in the coordinates of the model \param parameters of the entity as it stands. Errors
/// (input): an entity of another type; matrices or numbers that cannot be read.
[[nodiscard]] Expected<std::vector<std::string>> surface_values(const File& file, int number,
                                                                const Surface& surface,
                                                                const Parameters& parameters);

}  // namespace knead::iges
