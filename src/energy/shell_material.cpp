#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "knead/energy/shell_energy.hpp"
#include "knead/spline/basis.hpp"

namespace knead {
namespace {

Expected<double> positive(double value, const char* name) {
  if (std::isfinite(value) && value > 0) return value;
  return input_error(fmt::format("{} is not a {}", value, name), name, "use a finite number > 0");
}

/// ∫ N_i over the domain, as a share of its length.
double share_of(const KnotVector& knots, int i) {
  const Interval domain = knots.domain();
  return (basis_integral(knots, i, 1, domain.upper) - basis_integral(knots, i, 1, domain.lower)) /
         domain.length();
}

}  // namespace

Expected<ShellMaterial> ShellMaterial::at(const std::array<double, 2>& u) const {
  ShellMaterial here{young, poisson, thickness, density};
  for (const auto& [field, value] :
       {std::pair(&young_field, &here.young), std::pair(&thickness_field, &here.thickness)}) {
    if (!*field) continue;
    const auto x = (*field)->at(u);
    if (!x) return std::unexpected(x.error());
    *value = *x;
  }
  return here;
}

double mean_of(const SplineField<2>& field) {
  double sum = 0;
  const auto [m, n] = field.net();
  const KnotVector &u = field.knots()[0], &v = field.knots()[1];
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      sum += share_of(u, i) * share_of(v, j) *
             field.coefficients()[static_cast<std::size_t>(i * n + j)];
    }
  }
  return sum;
}

Expected<ShellMaterial> validated(const ShellMaterial& material) {
  if (auto ok = positive(material.young, "young"); !ok) return std::unexpected(ok.error());
  if (auto ok = positive(material.thickness, "thickness"); !ok) return std::unexpected(ok.error());
  if (!(material.poisson > -1 && material.poisson <= 0.5)) {
    return input_error(fmt::format("{} is not a Poisson's ratio", material.poisson), "poisson",
                       "use a number > -1 and <= 0.5");
  }
  if (!std::isfinite(material.density) || material.density < 0) {
    return input_error(fmt::format("{} is not a density", material.density), "density",
                       "use a finite number >= 0");
  }
  for (const auto& [field, name] : {std::pair(&material.young_field, "young"),
                                    std::pair(&material.thickness_field, "thickness")}) {
    if (!*field) continue;
    const std::vector<double>& c = (*field)->coefficients();
    const auto bad = std::ranges::find_if(c, [](double x) { return !(std::isfinite(x) && x > 0); });
    if (bad == c.end()) continue;
    const auto k = bad - c.begin(), n = static_cast<std::ptrdiff_t>((*field)->net()[1]);
    return input_error(fmt::format("{} is not a {}", *bad, name),
                       fmt::format("{}: coefficient ({}, {})", name, k / n, k % n),
                       "use finite numbers > 0");
  }
  return material;
}

Expected<FundamentalMaterial> validated_weights(const FundamentalMaterial& material) {
  for (const auto& [weights, name] : {std::pair(material.w1, "w1"), std::pair(material.w2, "w2")}) {
    for (const double w : weights) {
      if (!std::isfinite(w) || w < 0) {
        return input_error(fmt::format("{} is not a weight of a fundamental form", w), name,
                           "use finite numbers >= 0");
      }
    }
  }
  return material;
}

}  // namespace knead
