#pragma once

#include <functional>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead::brep {

inline constexpr double least_fitted_span = 1e-10;  // of all parameters
inline constexpr const char* not_fitted = "no spline follows this path";

/// The cubic spline that passes through the points of a path at its Greville abscissae, with spans halved until it is
/// within `tolerance` of the path at four even parameters inside each.
/// \param breaks ascending: the ends, and what the first spans lie between
/// \param corners of these breaks, at which the path may turn: triple knots
/// Errors: those of the path; more than 4,096 spans, or spans that cannot be halved further (numerical, `not_fitted`).
[[nodiscard]] Expected<Curve> fitted_curve(const std::function<Expected<Point>(double)>& path,
                                           std::vector<double> breaks, const std::vector<double>& corners,
                                           double tolerance);

}  // namespace knead::brep
