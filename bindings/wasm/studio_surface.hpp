#pragma once

#include <string>

#include "knead/spline/spline.hpp"

namespace knead::studio {

/// {"degree", "net", "knots_u", "knots_v", "weights" (null without), "points"} of a surface as JSON, in the order of
/// `Surface::control_points`. Every number reads back as the same bits.
[[nodiscard]] std::string surface_json(const Surface& surface);

}  // namespace knead::studio
