#pragma once

#include <array>
#include <vector>

#include "knead/energy/material.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {

/// One term of a quadratic energy: coefficient · ∫ ∂^a S · ∂^b S over the parameter domain.
template <int D>
struct EnergyTerm {
  double coefficient = 0;
  MultiIndex<D> a{}, b{};

  friend bool operator==(const EnergyTerm&, const EnergyTerm&) = default;
};

/// A quadratic energy is the list of its terms. The list is symmetric: a term (c, a, b), a != b, comes with (c, b, a).
template <int D>
using Energy = std::vector<EnergyTerm<D>>;

/// The stretch and bend energy of a `MaterialOf<D>`. Terms with a zero coefficient are left out.
template <int D>
[[nodiscard]] Energy<D> stretch_and_bend(const MaterialOf<D>& material);

/// Lets braces stand for a material.
[[nodiscard]] inline Energy<2> stretch_and_bend(const Material& material) { return stretch_and_bend<2>(material); }

/// ∫ |S|² · coefficient: the energy whose operator is the mass matrix (thesis Eq. 5.41 with constant μ).
template <int D>
[[nodiscard]] Energy<D> mass_energy(double coefficient = 1);

/// The same energy written on a stretched parameter domain: with û_d = factor_d · u_d a term of orders a, b is
/// multiplied by Π_d factor_d^(1 − a_d − b_d), so that K, computed on the knots as they are, is the matrix that the
/// knots multiplied by the factors would give. No knot is changed.
template <int D>
[[nodiscard]] Energy<D> on_scaled_domain(const Energy<D>& energy, const std::array<double, D>& factors);

}  // namespace knead
