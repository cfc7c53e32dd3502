#pragma once

#include <array>
#include <span>
#include <variant>
#include <vector>

#include "knead/spline/basis.hpp"

namespace knead {

/// A scalar spline on a parameter domain, f(u) = Σ_i c_i N_i(u): a coefficient that varies over a
/// shape (thesis § 5.5).
///
/// It has its own degrees and knots; the domain must be that of the spline it belongs to, bit for
/// bit. Coefficients are stored with the last direction fastest. Immutable.
template <int D>
class SplineField {
 public:
  /// Errors (input): a wrong number of coefficients for the knots; one that is not finite, by its
  /// index.
  [[nodiscard]] static Expected<SplineField> create(std::array<KnotVector, D> knots,
                                                    std::vector<double> coefficients);

  [[nodiscard]] const std::array<KnotVector, D>& knots() const { return knots_; }
  [[nodiscard]] const std::vector<double>& coefficients() const { return coefficients_; }
  [[nodiscard]] std::array<int, D> net() const;
  /// Smallest and largest coefficient: every value lies between them, as the basis is non-negative
  /// and sums to one.
  [[nodiscard]] Interval range() const;

  /// f on the grid of all combinations of the parameters, last direction fastest. At a knot the
  /// limit from `side`. Error: a parameter outside the domain.
  [[nodiscard]] Expected<std::vector<double>> on_grid(
      const std::array<std::span<const double>, D>& parameters, Side side = Side::right) const;
  /// The same for tabulated bases of its knots.
  [[nodiscard]] std::vector<double> on_grid(const std::array<const BasisTable*, D>& tables) const;
  /// One value.
  [[nodiscard]] Expected<double> at(const std::array<double, D>& u) const;

  friend bool operator==(const SplineField&, const SplineField&) = default;

 private:
  SplineField(std::array<KnotVector, D> knots, std::vector<double> coefficients)
      : knots_(std::move(knots)), coefficients_(std::move(coefficients)) {}

  std::array<KnotVector, D> knots_;
  std::vector<double> coefficients_;
};

/// A coefficient of an energy: a constant, or a function over the domain.
template <int D>
using Coefficient = std::variant<double, SplineField<D>>;

/// The smallest clamped knots whose splines contain those of all given knot vectors of one domain,
/// on that domain: the largest degree, all interior knots, each with the lowest continuity it has
/// in any of them. Errors: none given (usage), domains that differ (input).
[[nodiscard]] Expected<KnotVector> common_knots(std::span<const KnotVector> knots);

/// The same in every direction.
template <int D>
[[nodiscard]] Expected<std::array<KnotVector, D>> common_knots(
    std::span<const std::array<KnotVector, D>> knots);

/// The same field on other knots whose splines contain it, as those of `common_knots` do; on other
/// knots its interpolant at the Greville abscissae. Accuracy: rounding, times the condition of
/// interpolation (see `GrevilleInterpolation`); a field that already has these knots is returned
/// unchanged; a constant has its value in every coefficient.
template <int D>
[[nodiscard]] Expected<SplineField<D>> on_knots(const Coefficient<D>& field,
                                                const std::array<KnotVector, D>& knots);

/// The field of degree 1 through samples on a uniform grid over the domain, its ends included:
/// counts[d] >= 2 samples in direction d, last direction fastest. The samples are the coefficients;
/// samples >= 0 make a field >= 0.
template <int D>
[[nodiscard]] Expected<SplineField<D>> sampled_field(const std::array<Interval, D>& domain,
                                                     const std::array<int, D>& counts,
                                                     std::vector<double> samples);

/// The knots of that field.
template <int D>
[[nodiscard]] Expected<std::array<KnotVector, D>> sample_knots(
    const std::array<Interval, D>& domain, const std::array<int, D>& counts);

}  // namespace knead
