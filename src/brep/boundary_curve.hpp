#pragma once

#include "knead/spline/spline.hpp"

namespace knead::brep {

/// The boundary isocurve on which `direction` has its first (end = 0) or last (end = 1) parameter, over the knots of
/// the other direction: the net is contracted by the basis at that parameter. Rational if the surface is; a control
/// point whose weight becomes zero is placed at the origin with weight zero.
[[nodiscard]] Expected<Curve> boundary_curve(const Surface& surface, int direction, int end);

/// Diagonal of the bounding box of the control points.
[[nodiscard]] double net_diagonal(const Points& control_points);

}  // namespace knead::brep
