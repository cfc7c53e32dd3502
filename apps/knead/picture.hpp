#pragma once

#include <string>

#include "knead/spline/spline.hpp"

namespace knead::cli {

/// An SVG picture of |S_after − S_before| over the (u, v) domain, u to the right, v upwards, the
/// sides of the picture in proportion to the mean lengths of the isocurves; knot lines, and a scale
/// in `unit`.
[[nodiscard]] Expected<std::string> displacement_picture(const Surface& before,
                                                         const Surface& after,
                                                         const std::string& title,
                                                         const std::string& unit);

}  // namespace knead::cli
