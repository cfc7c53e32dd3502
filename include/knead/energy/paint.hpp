#pragma once

#include <functional>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "knead/energy/material_field.hpp"
#include "knead/energy/spline_field.hpp"

namespace knead {

/// A function of the parameters, in the units of the knots.
template <int D>
using ParameterFunction = std::function<double(const std::array<double, D>&)>;

struct FitOptions {
  double tolerance = 1e-6;  ///< absolute, on the values
  int max_coefficients = 1 << 16;
  /// Every direction is sampled at this many parameters at least: features narrower than the domain
  /// divided by this may be missed entirely.
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
/// Interpolation at Greville abscissae on the knots of `hint` (its degree and continuity are kept;
/// repeat knots where the function has kinks), then spans in which a sample is off by more than 0.9
/// tolerance are halved, in the direction in which the function's divided differences of order p +
/// 1 are large, with neighbouring spans kept within a factor 2, repeatedly. At a knot of
/// multiplicity p + 1, where the spline may jump, the function is evaluated at the knot, as the
/// right limit, and at the next smaller double, as the left one. With a `range` the coefficients
/// are clamped to it and the error is measured after that.
///
/// Guaranteed: |f − field| <= tolerance at every sample, max(2p + 3, min_samples / spans) per span
/// and direction, spread evenly; every value in `range`, samples or not. Between the samples
/// nothing can be promised for a function known only at points; the factor 0.9 allows for this, and
/// in tests with smooth functions the tolerance holds everywhere. Errors: tolerance not positive, a
/// value of the function that is not finite (input); more coefficients than allowed (numerical; the
/// message says what was reached).
template <int D>
[[nodiscard]] Expected<FieldFit<D>> fit_field(const ParameterFunction<D>& f,
                                              const std::array<KnotVector, D>& hint,
                                              const FitOptions& options = {});

/// All parameters with lower_d <= u_d <= upper_d.
template <int D>
struct ParameterBox {
  std::array<double, D> lower{}, upper{};
};

/// All parameters within `radius` of the centre, lengths measured with `Region::factors`: a disc on
/// a surface.
template <int D>
struct ParameterBall {
  std::array<double, D> centre{};
  double radius = 0;
};

/// A part of the parameter domain with a soft edge. Its weight is 1 inside and 1 − s³(10 − 15s +
/// 6s²) at the distance s · falloff, and zero beyond the fall-off: C2 outside a ball, C1 outside
/// the corners of a box.
///
/// Distances are (Σ (factor_d Δu_d)²)^½: with `DomainScaling::factors` they are proportions of the
/// normalised arc length, with ones they are parameters.
template <int D>
struct Region {
  std::variant<ParameterBox<D>, ParameterBall<D>> shape;
  double falloff = 0.1;  ///< > 0
  std::array<double, D> factors = ones();
  /// Directions in which the surface is closed: distances are taken the shorter way around.
  std::array<bool, D> closed{};

  /// The weight at u, 0 to 1. `domain` is the spline's.
  [[nodiscard]] double weight(const std::array<double, D>& u,
                              const std::array<Interval, D>& domain) const;

 private:
  static constexpr std::array<double, D> ones() {
    std::array<double, D> result{};
    result.fill(1);
    return result;
  }
};

struct PaintOptions {
  /// Of the difference between the largest and the smallest of the old and new values.
  double tolerance = 1e-3;
  int max_coefficients = 1 << 16;
};

/// Coefficients with new values in a region: (1 − w) old + w value, w the weight of the region.
///
/// w is represented as a spline with coefficients in [0, 1] on knots refined from `hint` (of the
/// desired degree), and all fields on knots common to it and the old fields, the same for all;
/// there each coefficient is moved towards the value by the coefficient of w. So
/// - no coefficient, hence no value, leaves the interval between the old coefficients and the value
/// (for a constant: between
///   the two numbers);
/// - a coefficient whose function does not reach the fall-off keeps its bits where the old field is
/// a constant or has
///   these knots, and one whose function lies where the weight is 1 becomes the value;
/// - coefficients that are convex together (`validated`) and are painted together with convex
/// values remain so;
/// - where the old field is constant the result differs from (1 − w) old + w value by the fit of w
/// alone; where it varies, by
///   the difference of blended coefficients and blended values too, and knots are halved until both
///   are below the tolerance at the samples of `fit_field`.
/// Errors: an invalid region or tolerance (input); more coefficients than allowed (numerical).
template <int D>
[[nodiscard]] Expected<std::vector<SplineField<D>>> paint(std::span<const Coefficient<D>> old,
                                                          std::span<const double> values,
                                                          const Region<D>& region,
                                                          const std::array<KnotVector, D>& hint,
                                                          const PaintOptions& options = {});

/// One coefficient.
template <int D>
[[nodiscard]] Expected<SplineField<D>> paint(const Coefficient<D>& old, double value,
                                             const Region<D>& region,
                                             const std::array<KnotVector, D>& hint,
                                             const PaintOptions& options = {});

/// New values for coefficients of a material; the others stay.
template <int D>
struct MaterialPaint {
  std::array<std::optional<double>, MaterialOf<D>::count> alpha{}, beta{};
  std::optional<double> mass{}, damping{};
};

/// The material with the values in the region, checked by `validated`.
template <int D>
[[nodiscard]] Expected<MaterialFieldOf<D>> paint(const MaterialFieldOf<D>& material,
                                                 const MaterialPaint<D>& values,
                                                 const Region<D>& region,
                                                 const std::array<KnotVector, D>& hint,
                                                 const PaintOptions& options = {});

}  // namespace knead
