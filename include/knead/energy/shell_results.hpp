#pragma once

#include <array>
#include <vector>

#include "knead/energy/shell_energy.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {

/// Stress and strain of a shell at one point, in orthonormal components of the rest shape's tangent plane.
struct ShellPointResults {
  std::array<double, 2> membrane = {0, 0};   ///< principal membrane forces n₁ >= n₂, force per length
  std::array<double, 2> moment = {0, 0};     ///< principal bending moments m₁ >= m₂, force times length per length
  std::array<double, 2> von_mises = {0, 0};  ///< on the face that the normal S_u × S_v leaves, and on the other
  double bending_strain = 0;                 ///< t/2 · max |κ|: the largest strain that bending adds at a face
};

/// The results of the sheet `current` that was `rest`, at parameters (rows u, v). With ε = ½(a − A), κ = B − b and C as
/// in `ShellEnergy`: n = t C:ε, m = t³/12 C:κ; the stress on the faces is n/t ± 6 m/t², its von Mises stress
/// √(σ₁² − σ₁ σ₂ + σ₂²). Not a number where one of the shapes has no normal.
/// Errors: parameters outside the domain (input), a rational denominator that is not positive (numerical).
[[nodiscard]] Expected<std::vector<ShellPointResults>> shell_results(const Surface& rest, const Surface& current,
                                                                     const ShellMaterial& material,
                                                                     const Parameters<2>& at);

}  // namespace knead
