#pragma once

#include <memory>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead {

/// Where values of a spline are taken, one per control point.
enum class Sites {
  greville,  ///< Greville abscissae: of Bézier pieces equidistant
  chebyshev  ///< the extrema of the Chebyshev spline: stable at every degree, also for values that
             ///< no spline has
};

/// Values of splines on given knots and weights at sites g, and back: v_i = Σ_j R_j(g_i) c_j.
///
/// Polynomial splines: v = (C_0 ⊗ … ⊗ C_{D−1}) c with the collocation matrices of
/// `GrevilleInterpolation` or `ChebyshevInterpolation`, and c by their factors. Rational splines:
/// R_j = w_j N_j / W with W = Σ w N, so that v W = Σ_j (w_j c_j) N_j at the sites. Order: as
/// control points, last direction fastest; a knot of multiplicity p + 1 contributes both one-sided
/// limits.
///
/// Accuracy of the spline through any values, in each direction and polynomial: its largest value
/// is at most 3.5 times that of the values for `Sites::chebyshev`, at every degree and for all
/// knots tried; for `Sites::greville` 3 times of degree 3, 1e5 and more of degree 22. Immutable,
/// const is thread-safe.
template <int D>
class SiteValues {
 public:
  /// Errors (numerical): sites that coincide by rounding; a denominator that is not positive;
  /// (input): a weight of 0, whose coefficient no value determines.
  [[nodiscard]] static Expected<SiteValues> create(const Spline<D>& shape, Sites sites);

  [[nodiscard]] int size() const;
  /// Parameters of the sites in one direction.
  [[nodiscard]] const std::vector<double>& abscissae(int direction) const;

  /// v for coefficients c, N × 3. Cost: O(N p) per direction.
  [[nodiscard]] Points values(const Points& coefficients) const;
  /// c for values v, N × 3. Cost: O(N p) per direction.
  [[nodiscard]] Points coefficients(Points values) const;

 private:
  struct Factors;
  explicit SiteValues(std::shared_ptr<const Factors> factors) : factors_(std::move(factors)) {}
  std::shared_ptr<const Factors> factors_;
};

}  // namespace knead
