#pragma once

#include <span>

namespace knead::detail {

/// Gauss–Legendre on [0, 1]: t, 1 − t and the weight, each correct to a relative ulp. On short
/// spans and for high degrees basis functions need 1 − t as exactly as t; taking it from the rule
/// on
/// [-1, 1] would lose digits near both ends.
template <class Real>
struct UnitGaussRule {
  std::span<const Real> t, complement, weights;
};

inline constexpr int max_unit_gauss_points = 64;

/// 1 <= points <= max_unit_gauss_points (asserted), Real double. Cost: a look-up after the first
/// use.
template <class Real>
[[nodiscard]] UnitGaussRule<Real> unit_gauss(int points);

extern template UnitGaussRule<double> unit_gauss<double>(int);

}  // namespace knead::detail
