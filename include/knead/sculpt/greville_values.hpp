#pragma once

#include <memory>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead {

/// Values of splines on given knots and weights at the Greville abscissae g, and back: v_i = Σ_j R_j(g_i) c_j.
///
/// Polynomial splines: v = (C_0 ⊗ … ⊗ C_{D−1}) c with the collocation matrices of `GrevilleInterpolation`, and c by
/// their factors. Rational splines: R_j = w_j N_j / W with W = Σ w N, so that v W = Σ_j (w_j c_j) N_j at the abscissae.
/// Order: as control points, last direction fastest; a knot of multiplicity p + 1 contributes both one-sided limits.
/// Immutable, const is thread-safe.
template <int D>
class GrevilleValues {
 public:
  /// Errors (numerical): abscissae that coincide by rounding; a denominator that is not positive; (input): a weight of
  /// 0, whose coefficient no value determines.
  [[nodiscard]] static Expected<GrevilleValues> create(const Spline<D>& shape);

  [[nodiscard]] int size() const;
  /// Parameters of the points in one direction.
  [[nodiscard]] const std::vector<double>& abscissae(int direction) const;

  /// v for coefficients c, N × 3. Cost: O(N p) per direction.
  [[nodiscard]] Points values(const Points& coefficients) const;
  /// c for values v, N × 3. Cost: O(N p) per direction.
  [[nodiscard]] Points coefficients(Points values) const;

 private:
  struct Factors;
  explicit GrevilleValues(std::shared_ptr<const Factors> factors) : factors_(std::move(factors)) {}
  std::shared_ptr<const Factors> factors_;
};

}  // namespace knead
