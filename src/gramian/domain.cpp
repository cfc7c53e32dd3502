#include <algorithm>

#include "methods.hpp"
#include "span_basis.hpp"
#include "unit_gauss.hpp"

namespace knead::detail {
namespace {

/// Entry (i, j), i <= j, over the spans of the domain alone, by Gauss points.
void integrate_cut_entry(const KnotVector& knots, int i, int j, GramianSet& set) {
  const int p = knots.degree(), orders[3] = {0, 1, 2};
  const UnitGaussRule rule = unit_gauss(p + 1);
  double g00 = 0, g11 = 0, g22 = 0, g10 = 0, g01 = 0;
  SpanValues values[3];
  for (int s = std::max(j, p); s <= std::min(i + p, knots.count() - 1); ++s) {
    const double h = knots[s + 1] - knots[s];
    if (!(h > 0)) continue;
    const int a = i - (s - p), b = j - (s - p);
    for (std::size_t g = 0; g < rule.t.size(); ++g) {
      span_basis(knots, s, rule.t[g], rule.complement[g], orders, 3, values);
      const double weight = h * rule.weights[g];
      g00 += weight * values[0][a] * values[0][b];
      g11 += weight * values[1][a] * values[1][b];
      g22 += weight * values[2][a] * values[2][b];
      g10 += weight * values[1][a] * values[0][b];
      g01 += weight * values[0][a] * values[1][b];
    }
  }
  set.g00.at(i, j) = g00;
  set.g11.at(i, j) = g11;
  set.g22.at(i, j) = g22;
  set.g10.at(j, i) = g01;
  set.g10.at(i, j) = g10;
}

}  // namespace

bool within_kernel_range(const KnotVector& knots) {
  // Repeated knots are split by 2^-300; spans must keep clear of that, and of overflow. Two knots that differ are as
  // far apart as their last bit at least, so only knots next to zero can be too near.
  constexpr double smallest = 0x1p-240, largest = 0x1p240, far_from_zero = 0x1p-180;
  const std::span<const double> x = knots.knots();
  if (x.back() - x.front() > largest) return false;
  auto it = std::ranges::lower_bound(x, -far_from_zero);
  for (it += it == x.begin() ? 1 : 0; it != x.end() && *(it - 1) <= far_from_zero; ++it) {
    const double length = *it - *(it - 1);
    if (length > 0 && length < smallest) return false;
  }
  return true;
}

void cut_to_domain(const KnotVector& knots, GramianSet& set) {
  const int p = knots.degree(), n = knots.count();
  const Interval domain = knots.domain();
  const auto redo = [&](int i, int j) {
    if (knots[j] < domain.lower || knots[i + p + 1] > domain.upper) integrate_cut_entry(knots, i, j, set);
  };
  for (int j = 0; j < p; ++j) {
    for (int i = 0; i <= j; ++i) redo(i, j);
  }
  for (int i = std::max(n - p, 0); i < n; ++i) {
    for (int j = std::max(i, p); j < std::min(n, i + p + 1); ++j) redo(i, j);
  }
}

}  // namespace knead::detail
