#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "knead/energy/fit_field.hpp"
#include "knead/energy/material_field.hpp"

namespace knead {

/// All parameters with lower_d <= u_d <= upper_d.
template <int D>
struct ParameterBox {
  std::array<double, D> lower{}, upper{};
};

/// All parameters within `radius` of the centre, lengths measured with `Region::factors`: a disc on a surface.
template <int D>
struct ParameterBall {
  std::array<double, D> centre{};
  double radius = 0;
};

/// A part of the parameter domain with a soft edge. Its weight is 1 inside and 1 − s³(10 − 15s + 6s²) at the distance
/// s · falloff, and zero beyond the fall-off: C2 outside a ball, C1 outside the corners of a box.
///
/// Distances are (Σ (factor_d Δu_d)²)^½: with `DomainScaling::factors` they are proportions of the normalised arc
/// length, with ones they are parameters.
template <int D>
struct Region {
  std::variant<ParameterBox<D>, ParameterBall<D>> shape;
  double falloff = 0.1;  ///< > 0
  std::array<double, D> factors = ones();
  /// Directions in which the surface is closed: distances are taken the shorter way around.
  std::array<bool, D> closed{};

  /// The weight at u, 0 to 1. `domain` is the spline's.
  [[nodiscard]] double weight(const std::array<double, D>& u, const std::array<Interval, D>& domain) const;

 private:
  static constexpr std::array<double, D> ones() {
    std::array<double, D> result{};
    result.fill(1);
    return result;
  }
};

struct PaintOptions {
  double tolerance = 1e-3;  ///< of the difference between the largest and the smallest of the old and new values
  int max_coefficients = 1 << 16;
};

/// Coefficients with new values in a region: (1 − w) old + w value, w the weight of the region.
///
/// w is represented as a spline with coefficients in [0, 1] on knots refined from `hint` (of the desired degree), and
/// all fields on knots common to it and the old fields, the same for all; there each coefficient is moved towards the
/// value by the coefficient of w. So
/// - no coefficient, hence no value, leaves the interval between the old coefficients and the value (for a constant:
/// between
///   the two numbers);
/// - a coefficient whose function does not reach the fall-off keeps its bits where the old field is a constant or has
///   these knots, and one whose function lies where the weight is 1 becomes the value;
/// - coefficients that are convex together (`validated`) and are painted together with convex values remain so;
/// - where the old field is constant the result differs from (1 − w) old + w value by the fit of w alone; where it
/// varies, by
///   the difference of blended coefficients and blended values too, and knots are halved until both are below the
///   tolerance at the samples of `fit_field`.
/// Errors: an invalid region or tolerance (input); more coefficients than allowed (numerical).
template <int D>
[[nodiscard]] Expected<std::vector<SplineField<D>>> paint(std::span<const Coefficient<D>> old,
                                                          std::span<const double> values, const Region<D>& region,
                                                          const std::array<KnotVector, D>& hint,
                                                          const PaintOptions& options = {});

/// One coefficient.
template <int D>
[[nodiscard]] Expected<SplineField<D>> paint(const Coefficient<D>& old, double value, const Region<D>& region,
                                             const std::array<KnotVector, D>& hint, const PaintOptions& options = {});

/// New values for coefficients of a material; the others stay.
template <int D>
struct MaterialPaint {
  std::array<std::optional<double>, MaterialOf<D>::count> alpha{}, beta{};
  std::optional<double> mass{}, damping{};
};

/// The material with the values in the region, checked by `validated`.
template <int D>
[[nodiscard]] Expected<MaterialFieldOf<D>> paint(const MaterialFieldOf<D>& material, const MaterialPaint<D>& values,
                                                 const Region<D>& region, const std::array<KnotVector, D>& hint,
                                                 const PaintOptions& options = {});

}  // namespace knead
