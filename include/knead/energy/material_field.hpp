#pragma once

#include "knead/energy/energy.hpp"
#include "knead/energy/spline_field.hpp"

namespace knead {

/// A material whose coefficients vary over the shape: those of `MaterialOf`, in the same order,
/// plus mass μ and damping γ, each a constant or a spline over the parameter domain (thesis § 5.5,
/// Eqs. 5.41, 5.42). Units as in `MaterialOf`; μ and γ per measure of the (scaled) parameter
/// domain. ν is a constant.
template <int D>
struct MaterialFieldOf {
  static constexpr std::size_t count = MaterialOf<D>::count;

  std::array<Coefficient<D>, count> alpha = as_coefficients(MaterialOf<D>{}.alpha);
  std::array<Coefficient<D>, count> beta = as_coefficients(MaterialOf<D>{}.beta);
  double poisson = 0;
  Coefficient<D> mass = 1.0;
  Coefficient<D> damping = 0.5;

  MaterialFieldOf() = default;
  /// A constant material.
  explicit MaterialFieldOf(const MaterialOf<D>& material, double mass_constant = 1,
                           double damping_constant = 0.5)
      : alpha(as_coefficients(material.alpha)),
        beta(as_coefficients(material.beta)),
        poisson(material.poisson),
        mass(mass_constant),
        damping(damping_constant) {}

  /// Its coefficients, where none of them varies: requires that (asserted).
  [[nodiscard]] MaterialOf<D> constants() const {
    MaterialOf<D> material;
    for (std::size_t k = 0; k < count; ++k) {
      material.alpha[k] = *std::get_if<double>(&alpha[k]);
      material.beta[k] = *std::get_if<double>(&beta[k]);
    }
    material.poisson = poisson;
    return material;
  }

  friend bool operator==(const MaterialFieldOf&, const MaterialFieldOf&) = default;

 private:
  static std::array<Coefficient<D>, count> as_coefficients(
      const std::array<double, count>& constants) {
    std::array<Coefficient<D>, count> result;
    for (std::size_t k = 0; k < count; ++k) result[k] = constants[k];
    return result;
  }
};

/// Accepts materials with a convex energy, coefficient by coefficient; the error names the
/// coefficient.
///
/// Checks: all numbers finite; every coefficient of the β_ij, α_ii, μ and γ >= 0; ν as of
/// `MaterialOf`, and where it is not 0 and a β_ii varies all β_ii are the same; and, where an α
/// varies, the matrix of the k-th coefficients of the α on `common_knots` positive semidefinite for
/// every k. As basis functions are non-negative and sum to one, the matrix α(u) is then a convex
/// combination of such matrices and the energy is convex. The check is sufficient, not necessary: a
/// field with positive values but a coefficient that is not positive is refused; refine its knots.
/// Where all varying α share their knots the check is exact in the sense of
/// `validated(MaterialOf)`; otherwise the fields are converted to common knots, with an allowance
/// of 1e-12 of the largest α for rounding.
template <int D>
[[nodiscard]] Expected<void> validated(const MaterialFieldOf<D>& material);

/// One term of an energy with a varying coefficient: factor · ∫ c(u) ∂^a S · ∂^b S.
template <int D>
struct FieldTerm {
  double factor = 1;
  Coefficient<D> coefficient = 0.0;
  MultiIndex<D> a{}, b{};
};

/// Symmetric like `Energy`: a term (c, a, b), a != b, comes with (c, b, a).
template <int D>
using FieldEnergy = std::vector<FieldTerm<D>>;

/// The terms of `stretch_and_bend`, stretch (first derivatives) and bend (second) separately. Zero
/// constants are left out.
template <int D>
[[nodiscard]] FieldEnergy<D> stretch_energy(const MaterialFieldOf<D>& material);
template <int D>
[[nodiscard]] FieldEnergy<D> bend_energy(const MaterialFieldOf<D>& material);
/// ∫ c |S|²: the mass matrix for c = μ (thesis Eq. 5.41), the damping matrix for c = γ (Eq. 5.42).
template <int D>
[[nodiscard]] FieldEnergy<D> weighted_mass_energy(const Coefficient<D>& coefficient);

/// The same on a stretched parameter domain, as for `Energy`; fields are functions of the knots as
/// they are.
template <int D>
[[nodiscard]] FieldEnergy<D> on_scaled_domain(const FieldEnergy<D>& energy,
                                              const std::array<double, D>& factors);

}  // namespace knead
