#pragma once

#include <span>

namespace knead {

/// An n-point Gauss–Legendre rule on [-1, 1]: ∫ f ≈ Σ weights[k] f(abscissae[k]), exact for
/// polynomials of degree 2n − 1. Abscissae ascend.
struct GaussRule {
  std::span<const double> abscissae;
  std::span<const double> weights;
};

inline constexpr int max_gauss_points = 64;

/// The rule with n points, 1 <= n <= max_gauss_points (asserted). Abscissae and weights are the
/// correctly computed values rounded to double: Newton's iteration on P_n, finished in quadruple
/// precision; error below 1 ulp. Cost: a look-up; the rules of up to 16 points are computed once,
/// on first use, and so are the others, thread-safely.
[[nodiscard]] GaussRule gauss_legendre(int n);

}  // namespace knead
