#pragma once

#include <vector>

#include "knead/spline/knot_vector.hpp"

namespace knead::figures {

/// One application of integration by parts to ∫ N^(b+k) I^k N^(a) du, I the integral from −∞, k =
/// 0, 1, …: with f = N^(b+k) and g = I^(k+1) N^(a), ∫ f dg = [f g] − ∫ g df.
struct ByParts {
  double whole = 0;     ///< ∫ f dg
  double boundary = 0;  ///< [f g] over the support
  /// ∫ g df: the next whole, or in the last step the sum over the jumps of f, its impulses.
  double rest = 0;
};

/// All steps until f is a sum of steps, for function i of a clamped knot vector whose support has
/// simple knots inside. Integrals by Gauss' rule, exact for these polynomials; jumps by
/// `derivative_jumps`. Requires: a, b <= p (asserted).
[[nodiscard]] std::vector<ByParts> by_parts(const KnotVector& knots, int i, int a, int b);

/// I^m N_i^(a) at u: a derivative while m < a.
[[nodiscard]] double integrated(const KnotVector& knots, int i, int a, int m, double u, Side side);

}  // namespace knead::figures
