#include "shell_quadrature.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/gauss_legendre.hpp"

namespace knead::detail {
namespace {

/// On the pieces between knots of the surface and of fields.
Expected<BasisQuadrature> on_pieces(const KnotVector& knots, std::vector<double> breaks,
                                    int points) {
  const GaussRule rule = gauss_legendre(points);
  BasisQuadrature result;
  std::ranges::sort(breaks);
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    const double half = (breaks[k + 1] - breaks[k]) / 2;
    for (std::size_t g = 0; g < rule.abscissae.size(); ++g) {
      result.parameters.push_back(std::clamp(breaks[k] + half + half * rule.abscissae[g], breaks[k],
                                             std::nextafter(breaks[k + 1], breaks[k])));
      result.weights.push_back(half * rule.weights[g]);
    }
  }
  auto basis = tabulate_basis(knots, result.parameters, 2);
  if (!basis) return std::unexpected(basis.error());
  result.basis = std::move(*basis);
  return result;
}

}  // namespace

Expected<ShellQuadrature> shell_quadrature(const std::array<KnotVector, 2>& knots,
                                           const ShellLaw& law, int gauss_points) {
  static constexpr std::array<const char*, 2> names = {"young", "thickness"};
  static constexpr std::array<int, 2> powers = {1, 3};  // in the bending stiffness
  const auto fields = law.fields();
  ShellQuadrature result;
  for (std::size_t d = 0; d < 2; ++d) {
    const auto [lower, upper] = knots[d].domain();
    std::vector<double> breaks;
    const auto add = [&, a = lower, b = upper](const KnotVector& k) {
      std::ranges::copy_if(k.knots(), std::back_inserter(breaks),
                           [&](double x) { return a <= x && x <= b; });
    };
    int degree = 0;
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (fields[f] == nullptr) continue;
      const KnotVector& stored = fields[f]->knots()[d];
      if (stored.domain().lower != lower || stored.domain().upper != upper) {
        return input_error(
            fmt::format("the domains [{}, {}] of the shape and [{}, {}] of the field differ", lower,
                        upper, stored.domain().lower, stored.domain().upper),
            names[f], "give a field over the domain of the shape");
      }
      degree += powers[f] * stored.degree();
      add(stored);
    }
    const int stored = knots[d].degree() + 1 + degree / 2;
    result.points[d] = gauss_points > 0 ? gauss_points : std::min(stored, max_gauss_points);
    if (breaks.empty()) {
      result.directions[d] = gauss_basis(knots[d], result.points[d], 2);
      continue;
    }
    add(knots[d]);
    auto made = on_pieces(knots[d], std::move(breaks), result.points[d]);
    if (!made) return std::unexpected(made.error());
    result.directions[d] = std::move(*made);
  }
  return result;
}

Expected<ShellCoefficients> coefficients_at(const ShellLaw& law, const std::array<double, 2>& u) {
  const auto* shell = std::get_if<ShellMaterial>(&law.material);
  if (shell == nullptr) return ShellCoefficients{};
  const auto here = shell->at(u);
  if (!here) return std::unexpected(here.error());
  return ShellCoefficients{here->young, here->thickness};
}

}  // namespace knead::detail
