#pragma once

#include "knead/gramian/gramian.hpp"

namespace knead::detail {

/// G^ab for any a, b >= 0 by Gauss points (thesis Alg. 5.1).
[[nodiscard]] BandMatrix gauss_gramian(const KnotVector& knots, int a, int b);

/// G^ab for any a, b >= 0 from jumps and repeated integrals (thesis Alg. 5.5, corrected).
[[nodiscard]] BandMatrix analytic_gramian(const KnotVector& knots, int a, int b);

[[nodiscard]] inline BandSymmetry symmetry_of(int a, int b) {
  return a == b ? BandSymmetry::symmetric : BandSymmetry::general;
}

}  // namespace knead::detail
