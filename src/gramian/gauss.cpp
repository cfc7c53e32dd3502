#include "methods.hpp"
#include "span_basis.hpp"
#include "unit_gauss.hpp"

namespace knead::detail {

BandMatrix gauss_gramian(const KnotVector& knots, int a, int b) {
  const int p = knots.degree();
  BandMatrix result(knots.count(), p, symmetry_of(a, b));
  if (a > p || b > p) return result;
  // The integrand has degree 2p − a − b on each span.
  const UnitGaussRule rule = unit_gauss(p + 1);
  const int orders[2] = {a, b};
  SpanValues values[2];
  for (const int span : knots.spans()) {
    const double h = knots[span + 1] - knots[span];
    for (std::size_t g = 0; g < rule.t.size(); ++g) {
      span_basis(knots, span, rule.t[g], rule.complement[g], orders, 2, values);
      const double weight = h * rule.weights[g];
      for (int i = 0; i <= p; ++i) {
        const double factor = weight * values[0][i];
        for (int j = a == b ? i : 0; j <= p; ++j) result.at(span - p + i, span - p + j) += factor * values[1][j];
      }
    }
  }
  return result;
}

}  // namespace knead::detail
