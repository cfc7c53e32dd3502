#pragma once

#include <vector>

#include "knead/session/session.hpp"

namespace knead {

/// Indices i n + j of the control points that are meant, in the order they are named, each once.
/// Errors (input): a number or row that there is not, with its place; none at all.
[[nodiscard]] Expected<std::vector<int>> indices_of(const NamedPoints& named, const std::array<int, 2>& net);

}  // namespace knead
