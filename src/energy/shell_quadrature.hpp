#pragma once

#include <array>

#include "knead/spline/basis.hpp"
#include "shell_law.hpp"

namespace knead::detail {

/// Gauss points of both directions, so many on each piece, which lies within one span of the
/// surface and one of each field of the material.
struct ShellQuadrature {
  std::array<BasisQuadrature, 2> directions;
  std::array<int, 2> points{};

  struct Place {
    double weight;
    std::array<double, 2> u;
  };
  /// Point k of the element whose first points are `begin`, the last direction fastest.
  [[nodiscard]] Place at(const std::array<int, 2>& begin, int k) const {
    const auto i = static_cast<std::size_t>(begin[0] + k / points[1]),
               j = static_cast<std::size_t>(begin[1] + k % points[1]);
    return {directions[0].weights[i] * directions[1].weights[j],
            {directions[0].parameters[i], directions[1].parameters[j]}};
  }
};

/// \param gauss_points per piece and direction; 0: p + 1, and as many more as the degrees of young
/// · thickness³ ask for. Error (input): a field on another domain.
[[nodiscard]] Expected<ShellQuadrature> shell_quadrature(const std::array<KnotVector, 2>& knots,
                                                         const ShellLaw& law, int gauss_points);

[[nodiscard]] Expected<ShellCoefficients> coefficients_at(const ShellLaw& law,
                                                          const std::array<double, 2>& u);

}  // namespace knead::detail
