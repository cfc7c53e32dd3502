#include "greville_interpolation.hpp"

#include <algorithm>

namespace knead {

std::vector<double> greville_sites(const KnotVector& knots) {
  const int n = knots.count(), p = knots.degree();
  const auto [lower, upper] = knots.domain();
  const auto [begin, end] = functions_on_domain(knots);
  std::vector<double> sites;
  for (int i = 0; i < n; ++i) {
    const auto clamped = [&, a = lower, b = upper](int k) { return std::clamp(knots[k], a, b); };
    const double first = clamped(i + 1);
    double sum = 0;
    for (int k = 2; k <= p; ++k) sum += clamped(i + k) - first;
    double g = std::clamp(first + sum / p, first, clamped(i + p));
    if (i < begin) g = lower;
    if (i >= end) g = upper;
    sites.push_back(g);
  }
  return sites;
}

Expected<GrevilleInterpolation> GrevilleInterpolation::create(const KnotVector& knots) {
  auto made = SiteInterpolation::create(knots, greville_sites(knots));
  if (!made) return std::unexpected(made.error());
  return GrevilleInterpolation(std::move(*made));
}

}  // namespace knead
