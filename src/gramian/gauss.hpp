#pragma once

#include "span_basis.hpp"
#include "unit_gauss.hpp"

namespace knead::detail {

/// add(i, j, share) for every span, every point and every pair of functions on the span: the
/// contributions to G^ab_ij by `points` Gauss points. For a = b only the upper half, i <= j.
template <class Real, class Add>
void accumulate_gauss(const KnotVector& knots, int a, int b, int points, Add add) {
  const int p = knots.degree();
  if (a > p || b > p) return;
  const UnitGaussRule<double> rule = unit_gauss<double>(points);
  const int orders[2] = {a, b}, different = a == b ? 1 : 2;
  SpanValues<Real> values[2];
  const SpanValues<Real>&f = values[0], &g = values[different - 1];
  for (const int span : knots.spans()) {
    const Real h = Real(knots[span + 1]) - Real(knots[span]);
    for (std::size_t k = 0; k < rule.t.size(); ++k) {
      span_basis(knots, span, Real(rule.t[k]), Real(rule.complement[k]), orders, different, values);
      const Real weight = h * Real(rule.weights[k]);
      for (int i = 0; i <= p; ++i) {
        const Real factor = weight * f[i];
        for (int j = a == b ? i : 0; j <= p; ++j) add(span - p + i, span - p + j, factor * g[j]);
      }
    }
  }
}

}  // namespace knead::detail
