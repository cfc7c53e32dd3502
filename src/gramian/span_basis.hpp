#pragma once

#include "knead/spline/knot_vector.hpp"

namespace knead::detail {

/// One derivative order of the p + 1 functions that live on a span.
using SpanValues = double[max_degree + 1];

/// N_{span-p+r}^(d) at u = x_span + t (x_{span+1} − x_span), r = 0 … p, for each d of `orders[0 … count)`.
///
/// Like `basis_derivatives`, but u is given by t and 1 − t inside the span and never formed, so that no digit is lost
/// on spans that are short beside the size of the knots. Values are sums of non-negative terms; a derivative is d
/// differences of values of degree p − d. Orders above p give zero.
void span_basis(const KnotVector& knots, int span, double t, double complement, const int* orders, int count,
                SpanValues* out);

}  // namespace knead::detail
