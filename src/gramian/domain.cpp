#include <algorithm>

#include "double_double.hpp"
#include "methods.hpp"
#include "simd/kernels.hpp"
#include "span_basis.hpp"
#include "unit_gauss.hpp"

namespace knead::detail {
namespace {

using Values = SpanValues<double>[3];

/// The functions on span s and their first two derivatives at t, of which the smaller of t and 1 −
/// t is given.
///
/// In twice the precision: near the end of a support the two terms of a derivative nearly cancel,
/// and their rounding errors would matter relative to the small remaining integral.
void exact_values(const KnotVector& knots, int s, double t, double complement, Values& out) {
  const DoubleDouble one = 1;
  const DoubleDouble from_left = t < complement ? t : one - complement,
                     from_right = one - from_left;
  const int p = knots.degree(), orders[3] = {0, 1, 2};
  SpanValues<DoubleDouble> values[3];
  span_basis(knots, s, from_left, from_right, orders, 3, values);
  for (int d = 0; d < 3; ++d) {
    for (int r = 0; r <= p; ++r) out[d][r] = static_cast<double>(values[d][r]);
  }
}

/// Adds the contribution of span s to the terms of functions whose common support extends beyond
/// the domain.
template <class Cut>
void add_span(const KnotVector& knots, int s, GramianSet& set, Cut cut) {
  const int p = knots.degree();
  const UnitGaussRule<double> rule = unit_gauss<double>(p + 1);
  Values values;
  for (std::size_t g = 0; g < rule.t.size(); ++g) {
    exact_values(knots, s, rule.t[g], rule.complement[g], values);
    const double weight = (knots[s + 1] - knots[s]) * rule.weights[g];
    for (int b = 0; b <= p; ++b) {
      for (int a = 0; a <= b; ++a) {
        const int i = s - p + a, j = s - p + b;
        if (!cut(i, j)) continue;
        set.g00.at(i, j) += weight * values[0][a] * values[0][b];
        set.g11.at(i, j) += weight * values[1][a] * values[1][b];
        set.g22.at(i, j) += weight * values[2][a] * values[2][b];
        set.g10.at(i, j) += weight * values[1][a] * values[0][b];
        if (i != j) set.g10.at(j, i) += weight * values[1][b] * values[0][a];
      }
    }
  }
}

}  // namespace

bool within_kernel_range(const KnotVector& knots) {
  if (knots.degree() > max_kernel_degree) return false;
  // Repeated knots are split by 2^-300; spans must stay clear of that, and of overflow. Distinct
  // knots differ by at least their last bit, so only knots next to zero can be too close.
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
  if (knots.clamped()) return;
  // i <= j share [x_j, x_{i+p+1}].
  const auto cut = [&](int i, int j) {
    return knots[j] < domain.lower || knots[i + p + 1] > domain.upper;
  };
  for (int j = 0; j < n; j = j == p - 1 ? std::max(p, n - p) : j + 1) {
    for (int i = std::max(0, j - p); i <= j; ++i) {
      if (!cut(i, j)) continue;
      for (BandMatrix* matrix : {&set.g00, &set.g11, &set.g22, &set.g10}) matrix->at(i, j) = 0;
      set.g10.at(j, i) = 0;
    }
  }
  for (int s = p; s < n; s = s == 2 * p - 1 ? std::max(2 * p, n - p) : s + 1) {
    if (knots[s] < knots[s + 1]) add_span(knots, s, set, cut);
  }
}

}  // namespace knead::detail
