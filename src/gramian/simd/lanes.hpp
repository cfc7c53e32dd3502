// Included by one translation unit per instruction set, as the vectors of the room base are.
#pragma once

#include "base/simd/lanes.hpp"

namespace knead::detail::KNEAD_ISA {

constexpr double factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

/// The constants that turn S into inner products (T[k][l] = k! l! / (k + l − 1)! S[k][l]), with the
/// 1/K of each N and the p of each derivative.
struct Factors {
  double g00, g10, g11, g22;
};
constexpr Factors factors(int p) {
  const int K = p + 1;
  return {factorial(p) * factorial(p) / factorial(2 * K - 1),
          factorial(p) * factorial(p) / factorial(2 * p),
          factorial(p) * factorial(p) / factorial(2 * p - 1),
          p < 2 ? 0 : factorial(p) * factorial(p) / factorial(2 * p - 3)};
}

/// A zero distance of k knots is read as k times this: an infinitesimal splitting of repeated
/// knots.
inline constexpr double splitting = 0x1p-300;

}  // namespace knead::detail::KNEAD_ISA
