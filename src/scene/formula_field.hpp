#pragma once

#include <optional>
#include <string>

#include "knead/energy/paint.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// A formula (`Formula`) over the domain of a surface, as a bicubic spline within a tolerance of it
/// (`fit_field`). Variables: `s` and `t`, the fractions of the domain along u and v, and `x`, `y`,
/// `z`, the place on the surface there.
///
/// `tolerance` is absolute; by default it is 1e-6 of the largest value on a grid of 33 × 33 places.
/// With a `range` all values are in it. Cost: some evaluations of the formula per coefficient, of
/// which a smooth formula needs tens to thousands; beyond 16,384 it is refused. Errors: those of
/// `Formula::parse` and `fit_field`; a value outside of the range (input), which is told with its
/// place.
[[nodiscard]] Expected<SplineField<2>> formula_field(const std::string& formula,
                                                     const Surface& surface,
                                                     std::optional<double> tolerance = {},
                                                     const std::optional<Interval>& range = {});

}  // namespace knead
