#pragma once

#include <array>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead {

/// The cells of knots in which nothing moves, since all control points that count there are held:
/// the spans of u and v, by their left knots, in order. \param held one flag for each control point
[[nodiscard]] std::vector<std::array<int, 2>> held_cells(const Surface& surface,
                                                         const std::vector<bool>& held);

}  // namespace knead
