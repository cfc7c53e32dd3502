#pragma once

#include <memory>

#include "knead/energy/shell_energy.hpp"

namespace knead {

/// The weights of `FormEnergy`, each finite and >= 0.
struct FormWeights {
  double w1 = 1;  ///< of the metric: energy per length⁴ and measure of the domain
  double w2 = 1;  ///< of a curve's curvature: energy times length² per measure; volumes have none

  friend bool operator==(const FormWeights&, const FormWeights&) = default;
};

/// The energy of differences of fundamental forms of curves and volumes, as `ShellEnergy::of_forms`
/// is that of surfaces (thesis Eqs. 3.19 to 3.22; Terzopoulos, Platt, Barr and Fleischer 1987):
///
///   curve   W(S) = ∫ w1 (S'·S' − S⁰'·S⁰')² + w2 (κ − κ⁰)² du,
///   volume  W(S) = ∫ w1 Σ_ij (S_i·S_j − S⁰_i·S⁰_j)² du dv dw,
///
/// over the knots as they are, 0 the rest shape, κ = |S' × S''|/|S'|³ the curvature. The torsion of
/// curves is left out, so that a curve that is bent at rest turns out of its plane at no cost where
/// only that changes its torsion. Rigid motions cost nothing; a volume has no other motions that
/// do, and its mirror image costs nothing either.
///
/// Integrated by Gauss points on every span: of polynomial volumes the integral is exact; that of
/// curvature is not. The unknowns are the control points (N × 3); in Hessians unknown 3 i + c is
/// coordinate c of control point i. Immutable, const is thread-safe.
template <int D>
class FormEnergy {
 public:
  /// \param gauss_points per span and direction; 0: 2 p + 1, of which the metric of polynomial
  /// shapes is exact. Errors: bad weights; a curve of degree 1 with w2 > 0, as it has no curvature
  /// (input); a curve at rest whose tangent vanishes at a Gauss point, a rational denominator that
  /// is not positive (numerical).
  [[nodiscard]] static Expected<FormEnergy> create(const Spline<D>& rest,
                                                   const FormWeights& weights,
                                                   int gauss_points = 0);

  /// The part of the metric as membrane, that of curvature as bending. Where a curve has no tangent
  /// at a Gauss point this and all that follows is not finite.
  [[nodiscard]] ShellParts energy(const Points& x) const;
  /// ∂W/∂x, N × 3. At a point where a curve that was bent at rest is straight, curvature has no
  /// derivative: its part is taken as 0.
  [[nodiscard]] Points gradient(const Points& x) const;
  /// ∂²W/∂x², 3N × 3N, symmetric, every entry of the tensor band stored. It may be indefinite.
  [[nodiscard]] SparseMatrix hessian(const Points& x) const;
  /// Its positive semidefinite part of first derivatives of the forms (Gauss and Newton's).
  [[nodiscard]] SparseMatrix material_hessian(const Points& x) const;
  /// The same and what tension adds, the positive principal strains of the metric: positive
  /// semidefinite.
  [[nodiscard]] SparseMatrix tense_hessian(const Points& x) const;

  [[nodiscard]] int size() const;
  /// ∫ w1 Σ (S⁰_i·S⁰_j)²: the energy of a stretch of one, the scale that rounding is judged by.
  [[nodiscard]] double stretching_scale() const;

 private:
  struct Data;
  explicit FormEnergy(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace knead
