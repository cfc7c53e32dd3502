#pragma once

#include "knead/spline/spline.hpp"

namespace knead::brep {

/// The isocurve on which `direction` has the parameter `at`, seen from this side of a knot, over
/// the knots of the other direction. Rational if the surface is; a control point whose weight
/// becomes zero is placed at the origin with weight zero.
[[nodiscard]] Expected<Curve> isocurve(const Surface& surface, int direction, double at,
                                       Side side = Side::right);

/// The boundary isocurve on which `direction` has its first (end = 0) or last (end = 1) parameter,
/// over the knots of the other direction: the net is contracted by the basis at that parameter.
[[nodiscard]] Expected<Curve> boundary_curve(const Surface& surface, int direction, int end);

/// The same curve the other way round, on the same domain.
[[nodiscard]] Curve turned(const Curve& curve);

/// Diagonal of the bounding box of the control points.
[[nodiscard]] double net_diagonal(const Points& control_points);

}  // namespace knead::brep
