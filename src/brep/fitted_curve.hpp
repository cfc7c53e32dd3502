#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead::brep {

inline constexpr const char* not_fitted = "no spline follows this path";

using PathPoint = std::function<Expected<Point>(double)>;

/// The cubic spline that passes through the points of a path at its Greville abscissae, with spans
/// halved until it is within `tolerance` of the path at four even parameters inside each. The first
/// spans end at eight even divisions of `range` and at the corners. \param corners at which the
/// path may turn: triple knots. A corner has an abscissa a third of a span beside it: where
///   a division is only rounding away (of a circle of four arcs, every other one is), no number is
///   left in between, and the conditions of Schoenberg and Whitney fail. The corner then takes its
///   place. Corners that cannot be told from an end or from the one before have no knot of their
///   own.
/// Errors: those of the path; more than 4,096 spans, or spans that cannot be halved further
/// (numerical, `not_fitted`).
[[nodiscard]] Expected<Curve> fitted_curve(const PathPoint& path, const Interval& range,
                                           const std::vector<double>& corners, double tolerance);

/// The same for a path over [0, 1], to 1e-8 of its size; none: it is a point.
/// \param corners in any order
[[nodiscard]] Expected<std::optional<Curve>> lifted_curve(const PathPoint& path,
                                                          std::vector<double> corners);

}  // namespace knead::brep
