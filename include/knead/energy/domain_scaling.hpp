#pragma once

#include <array>

#include "knead/spline/spline.hpp"

namespace knead {

/// The units in which a model is computed.
///
/// Coordinates are divided by `length`, parameters of direction d are multiplied by `factors[d]`.
/// The default changes nothing: raw units. The normalised scaling makes the model scale-free:
/// `length` is the D-th root of the rest shape's measure (length, area, volume), and the sides of
/// the parameter domain become the mean isocurve lengths in that unit, so that a unit square sheet
/// and its copy of any size, position and affine parametrisation give the same numbers, and a dent
/// keeps its proportions on a long strip.
template <int D>
struct DomainScaling {
  double length = 1;
  std::array<double, D> factors = ones();

  friend bool operator==(const DomainScaling&, const DomainScaling&) = default;

 private:
  static constexpr std::array<double, D> ones() {
    std::array<double, D> result{};
    result.fill(1);
    return result;
  }
};

/// The normalised scaling of a rest shape. The measure ∫|S_u × S_v| (∫|S_u|, ∫|det|) and the mean
/// isocurve lengths (1/|V|)∫∫|S_u| du dv are integrated by p + 4 Gauss points per span. Invariant
/// (up to rounding) under rigid motion, uniform scaling, exchange and reversal of the directions
/// and affine maps of the knots. Errors: the shape has no length, area or volume (numerical); a
/// rational denominator that is not positive.
template <int D>
[[nodiscard]] Expected<DomainScaling<D>> normalised_scaling(const Spline<D>& rest);

/// The same lengths of the parameter domain in another unit of length: for a patch coupled to
/// others.
template <int D>
[[nodiscard]] DomainScaling<D> in_unit(const DomainScaling<D>& scaling, double length);

}  // namespace knead
