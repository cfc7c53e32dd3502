#pragma once

#include <functional>
#include <optional>

#include "knead/energy/spline_field.hpp"

namespace knead {

/// A function of the parameters, in the units of the knots.
template <int D>
using ParameterFunction = std::function<double(const std::array<double, D>&)>;

struct FitOptions {
  double tolerance = 1e-6;  ///< absolute, on the values
  int max_coefficients = 1 << 16;
  /// Every direction is sampled at this many parameters at least: features narrower than the domain divided by this may
  /// be missed entirely.
  int min_samples = 64;
  /// Coefficients, and hence all values, are kept in this interval.
  std::optional<Interval> range = {};
};

template <int D>
struct FieldFit {
  SplineField<D> field;
  double error = 0;  ///< largest |f − field| at the samples
  long long samples = 0;
};

/// A spline within a tolerance of a function: the representation of a material given as a formula.
///
/// Interpolation at Greville abscissae on the knots of `hint` (its degree and continuity are kept; repeat knots where
/// the function has kinks), then spans in which a sample is off by more than 0.9 tolerance are halved, in the direction
/// in which the function's divided differences of order p + 1 are large, with neighbouring spans kept within a factor
/// 2, repeatedly. At a knot of multiplicity p + 1, where the spline may jump, the function is evaluated at the knot, as
/// the right limit, and at the next smaller double, as the left one. With a `range` the coefficients are clamped to it
/// and the error is measured after that.
///
/// Guaranteed: |f − field| <= tolerance at every sample, max(2p + 3, min_samples / spans) per span and direction,
/// spread evenly; every value in `range`, samples or not. Between the samples nothing can be promised for a function
/// known only at points; the factor 0.9 allows for this, and in tests with smooth functions the tolerance holds
/// everywhere. Errors: tolerance not positive, a value of the function that is not finite (input); more coefficients
/// than allowed (numerical; the message says what was reached).
template <int D>
[[nodiscard]] Expected<FieldFit<D>> fit_field(const ParameterFunction<D>& f, const std::array<KnotVector, D>& hint,
                                              const FitOptions& options = {});

}  // namespace knead
