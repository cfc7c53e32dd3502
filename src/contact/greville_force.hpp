#pragma once

#include <vector>

#include "knead/energy/domain_scaling.hpp"
#include "knead/energy/stiffness.hpp"
#include "spline/interpolation/site_values.hpp"

namespace knead {

/// The analytic force route: F = ∫ Φᵀ f with f interpolated at the Greville abscissae g, then
/// integrated exactly:
///
///   f_h = Σ_j c_j R_j,  f_h(g_i) = f(S(g_i)),      F = M c,   M_ij = ∫ R_i R_j dû.
///
/// Polynomial splines: c = (C_0⁻¹ ⊗ … ⊗ C_{D−1}⁻¹) f(S(g)) with the collocation matrices of
/// `GrevilleInterpolation` and M = ⊗ G00, both applied direction by direction, never assembled.
/// Rational splines: R_j = w_j N_j / W with W = Σ w N, so that f_h(g) W(g) = Σ_j (w_j c_j) N_j(g):
/// interpolate f times the denominator in the polynomial basis, divide the coefficients by the
/// weights, and multiply by the rational mass matrix (Gauss points, see `StiffnessOptions`). This
/// reproduces constants: a constant f has c_j = f, and F is its load to the accuracy of M.
/// (Interpolating f/W and using polynomial Gramians, F_i = w_i Σ_j G_ij c_j, would be consistent
/// too but not exact for constants.)
///
/// Accuracy against ∫ Φᵀ f: for f ∘ S with p + 1 continuous derivatives on every span the
/// interpolation error, hence each F_i / ∫ R_i, is O(h^{p+1}). A collision force has a kink at the
/// edge of the contact: O(h) there, and forces extend beyond the edge with decaying, alternating
/// signs, as interpolation does (docs/materials-and-loads.md has figures). F is not the gradient of
/// a potential: its derivative is not symmetric. Use it as a lagged correction.
///
/// Order of points: as control points, last direction fastest; the points are those of
/// `GrevilleInterpolation`, with both one-sided limits at knots of multiplicity p + 1. Immutable,
/// const is thread-safe.
template <int D>
class GrevilleForce {
 public:
  /// Errors (numerical): abscissae that coincide by rounding; a denominator that is not positive;
  /// (input): a weight of 0, whose coefficient no force determines.
  [[nodiscard]] static Expected<GrevilleForce> create(const Spline<D>& shape,
                                                      const DomainScaling<D>& scaling,
                                                      const StiffnessOptions& options = {});

  [[nodiscard]] int size() const { return mass_.size(); }
  /// Parameters of the points in one direction.
  [[nodiscard]] const std::vector<double>& abscissae(int direction) const {
    return values_.abscissae(direction);
  }

  /// S(g) for control points x, N × 3, of the same knots and weights. Cost: O(N p) per direction.
  [[nodiscard]] Points places(const Points& x) const { return values_.values(x); }

  /// F for forces per measure of the scaled domain at the points, N × 3. Cost: O(N p) per
  /// direction.
  [[nodiscard]] Points forces(Points point_forces) const;

  /// F at control points x for a force that depends on the place: point_force(const Point&) ->
  /// Point.
  template <class F>
  [[nodiscard]] Points greville_force(const Points& x, const F& point_force) const {
    Points f = places(x);
    for (Eigen::Index i = 0; i < f.rows(); ++i)
      f.row(i) = Point(point_force(Point(f.row(i)))).transpose();
    return forces(std::move(f));
  }

 private:
  GrevilleForce(Stiffness<D> mass, SiteValues<D> values)
      : mass_(std::move(mass)), values_(std::move(values)) {}

  Stiffness<D> mass_;
  SiteValues<D> values_;
};

}  // namespace knead
