#pragma once

#include <array>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {

/// The constants of the stretch and bend energy of a D-variate spline. The upper triangle of a
/// symmetric D × D matrix, row by row: 11 for curves, 11, 12, 22 for surfaces, 11, 12, 13, 22, 23,
/// 33 for volumes.
///
///   E(S) = ∫ Σ_i α_ii |S_i|² + 2 Σ_{i<j} α_ij S_i·S_j + Σ_i β_ii |S_ii|² + 2 Σ_{i<j} β_ij |S_ij|²
///            + 2 ν Σ_{i<j} √(β_ii β_jj) S_ii·S_jj du,
///
/// which with ν = 0 is thesis Eq. 4.8 at D = 2 and, with equal constants, Eq. 5.43 at D = 3. α
/// resists stretch, β resists bending, and ν, Poisson's ratio, couples bending in one direction
/// with that in others (`thin_plate`). Units: those of the equation; see `DomainScaling` for the
/// normalised ones.
template <int D>
struct MaterialOf {
  static constexpr std::size_t count = D * (D + 1) / 2;
  /// Position of the coefficient ij, i <= j, counted from 0.
  static constexpr std::size_t place(int i, int j) {
    return static_cast<std::size_t>(i * D - i * (i - 1) / 2 + j - i);
  }

  std::array<double, count> alpha = filled(1, 0);
  std::array<double, count> beta = filled(0.01, 0.01);
  double poisson = 0;  ///< ν

  friend bool operator==(const MaterialOf&, const MaterialOf&) = default;

 private:
  static constexpr std::array<double, count> filled(double same, double mixed) {
    std::array<double, count> result{};
    for (int i = 0; i < D; ++i) {
      for (int j = i; j < D; ++j) result[place(i, j)] = i == j ? same : mixed;
    }
    return result;
  }
};

using Material = MaterialOf<2>;

/// Bending alone, as of a Kirchhoff plate of this rigidity D and Poisson's ratio ν (S. Timoshenko,
/// S. Woinowsky-Krieger, *Theory of Plates and Shells*, 1959, Eq. 41), of which the energy is twice
/// the strain energy where the parameters measure lengths:
///
///   E(S) = D ∫ |S_uu|² + |S_vv|² + 2 ν S_uu·S_vv + 2 (1 − ν) |S_uv|² du dv.
///
/// ν changes what free edges do: with position and tangent held all round E does not depend on it.
[[nodiscard]] Material thin_plate(double rigidity, double poisson);

/// Accepts exactly the materials with a convex energy: all finite, the matrix α positive
/// semidefinite, every β >= 0, and −1/(D − 1) <= ν <= 1, 0 at D = 1. The error names the
/// coefficient.
template <int D>
[[nodiscard]] Expected<MaterialOf<D>> validated(const MaterialOf<D>& material);

/// Lets braces stand for a material.
[[nodiscard]] inline Expected<Material> validated(const Material& material) {
  return validated<2>(material);
}

/// One term of a quadratic energy: coefficient · ∫ ∂^a S · ∂^b S over the parameter domain.
template <int D>
struct EnergyTerm {
  double coefficient = 0;
  MultiIndex<D> a{}, b{};

  friend bool operator==(const EnergyTerm&, const EnergyTerm&) = default;
};

/// A quadratic energy is the list of its terms. The list is symmetric: a term (c, a, b), a != b,
/// comes with (c, b, a).
template <int D>
using Energy = std::vector<EnergyTerm<D>>;

/// The stretch and bend energy of a `MaterialOf<D>`. Terms with a zero coefficient are left out.
template <int D>
[[nodiscard]] Energy<D> stretch_and_bend(const MaterialOf<D>& material);

/// Lets braces stand for a material.
[[nodiscard]] inline Energy<2> stretch_and_bend(const Material& material) {
  return stretch_and_bend<2>(material);
}

/// ∫ |S|² · coefficient: the energy whose operator is the mass matrix (thesis Eq. 5.41 with
/// constant μ).
template <int D>
[[nodiscard]] Energy<D> mass_energy(double coefficient = 1);

/// The same energy written on a stretched parameter domain: with û_d = factor_d · u_d a term of
/// orders a, b is multiplied by Π_d factor_d^(1 − a_d − b_d), so that K, computed on the knots as
/// they are, is the matrix that the knots multiplied by the factors would give. No knot is changed.
template <int D>
[[nodiscard]] Energy<D> on_scaled_domain(const Energy<D>& energy,
                                         const std::array<double, D>& factors);

}  // namespace knead
