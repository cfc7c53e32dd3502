#include "span_basis.hpp"

#include <algorithm>

namespace knead::detail {

void span_basis(const KnotVector& knots, int span, double t, double complement, const int* orders, int count,
                SpanValues* out) {
  const int p = knots.degree();
  const double a = knots[span], b = knots[span + 1], h = b - a;
  double left[max_degree + 2], right[max_degree + 2];
  // Every lower degree is kept: the derivative of order d starts from the values of degree p − d.
  double values[max_degree + 1][max_degree + 1];
  values[0][0] = 1;
  for (int q = 1; q <= p; ++q) {
    left[q] = (a - knots[span + 1 - q]) + h * t;
    right[q] = (knots[span + q] - b) + h * complement;
    double saved = 0;
    for (int r = 0; r < q; ++r) {
      const double quotient = values[q - 1][r] / (knots[span + 1 + r] - knots[span + 1 - q + r]);
      values[q][r] = saved + right[r + 1] * quotient;
      saved = left[q - r] * quotient;
    }
    values[q][q] = saved;
  }
  for (int k = 0; k < count; ++k) {
    double* result = out[k];
    std::fill_n(result, p + 1, 0.0);
    if (orders[k] > p) continue;
    std::copy_n(values[p - orders[k]], p - orders[k] + 1, result);
    for (int q = p - orders[k] + 1; q <= p; ++q) {
      double before = 0;
      for (int r = 0; r < q; ++r) {
        const double quotient = q * result[r] / (knots[span + 1 + r] - knots[span + 1 - q + r]);
        result[r] = before - quotient;
        before = quotient;
      }
      result[q] = before;
    }
  }
}

}  // namespace knead::detail
