#pragma once

#include <span>

namespace knead::detail {

/// Gauss–Legendre on [0, 1]: t, 1 − t and the weight, each correct to a relative ulp. On short spans and high degrees
/// basis functions need 1 − t as exactly as t; taking it from the rule on [-1, 1] would lose digits near both ends.
struct UnitGaussRule {
  std::span<const double> t, complement, weights;
};

inline constexpr int max_unit_gauss_points = 64;

/// 1 <= points <= max_unit_gauss_points (asserted). Cost: a table look-up after the first use.
[[nodiscard]] UnitGaussRule unit_gauss(int points);

}  // namespace knead::detail
