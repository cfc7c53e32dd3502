#pragma once

#include <array>

#include "knead/spline/spline.hpp"

namespace knead {

/// The units a model is computed in.
///
/// Coordinates are divided by `length`, parameters of direction d are multiplied by `factors[d]`. The normalised
/// scaling makes the model scale-free: `length` is the square root of the rest surface's area, and the sides of the
/// parameter domain become the mean lengths of the isocurves in that unit, so that a unit square sheet and its copy of
/// any size, position and affine parametrisation obey the same numbers, and a dent keeps its proportions on a long
/// strip.
struct DomainScaling {
  double length = 1;
  std::array<double, 2> factors = {1, 1};

  friend bool operator==(const DomainScaling&, const DomainScaling&) = default;
};

/// The normalised scaling of a rest surface. Area ∫|S_u × S_v| and mean isocurve lengths (1/|V|)∫∫|S_u| du dv are
/// integrated by p + 4 Gauss points per span. Invariant (up to rounding) under rigid motion, uniform scaling, exchange
/// and reversal of the directions and affine maps of the knots.
/// Errors: the surface has no area (numerical); a rational denominator that is not positive.
[[nodiscard]] Expected<DomainScaling> normalised_scaling(const Surface& rest);

}  // namespace knead
