#pragma once

#include <algorithm>

#include "knead/spline/knot_vector.hpp"

namespace knead::detail {

/// One derivative order of the p + 1 functions on a span.
template <class Real>
using SpanValues = Real[max_degree + 1];

/// N_{span-p+r}^(d) at u = lower + t (upper − lower), r = 0 … p, for each d of `orders[0 … count)`.
///
/// [lower, upper] is a piece of the span or all of it. Like `basis_derivatives`, but u is given by
/// t and 1 − t inside the piece and never formed, so that no digits are lost on spans that are
/// short relative to the size of the knots. Values are sums of non-negative terms; a derivative is
/// d differences of values of degree p − d. Orders above p give zero.
template <class Real>
void span_basis(const KnotVector& knots, int span, double lower, double upper, Real t,
                Real complement, const int* orders, int count, SpanValues<Real>* out) {
  const int p = knots.degree();
  const Real a = lower, b = upper, h = b - a;
  Real left[max_degree + 2], right[max_degree + 2];
  // Every lower degree is kept: the derivative of order d starts from the values of degree p − d.
  Real values[max_degree + 1][max_degree + 1];
  values[0][0] = 1;
  for (int q = 1; q <= p; ++q) {
    left[q] = (a - Real(knots[span + 1 - q])) + h * t;
    right[q] = (Real(knots[span + q]) - b) + h * complement;
    Real saved = 0;
    for (int r = 0; r < q; ++r) {
      const Real quotient =
          values[q - 1][r] / (Real(knots[span + 1 + r]) - Real(knots[span + 1 - q + r]));
      values[q][r] = saved + right[r + 1] * quotient;
      saved = left[q - r] * quotient;
    }
    values[q][q] = saved;
  }
  for (int k = 0; k < count; ++k) {
    Real* result = out[k];
    std::fill_n(result, p + 1, Real(0));
    if (orders[k] > p) continue;
    std::copy_n(values[p - orders[k]], p - orders[k] + 1, result);
    for (int q = p - orders[k] + 1; q <= p; ++q) {
      Real before = 0;
      for (int r = 0; r < q; ++r) {
        const Real quotient =
            Real(q) * result[r] / (Real(knots[span + 1 + r]) - Real(knots[span + 1 - q + r]));
        result[r] = before - quotient;
        before = quotient;
      }
      result[q] = before;
    }
  }
}

/// The same with the whole span as the piece.
template <class Real>
void span_basis(const KnotVector& knots, int span, Real t, Real complement, const int* orders,
                int count, SpanValues<Real>* out) {
  span_basis(knots, span, knots[span], knots[span + 1], t, complement, orders, count, out);
}

}  // namespace knead::detail
