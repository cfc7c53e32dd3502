#pragma once

#include <cmath>
#include <limits>

#include "knead/gramian/band_matrix.hpp"
#include "support/quad_gramian.hpp"

namespace knead::testing {

/// Below this doubles lose digits on the way: such entries are left out of comparisons.
inline const Quad smallest_compared = Quad(1e-280);

/// The largest error of an entry beside ∫|N_i^(a) N_j^(b)|, or beside the largest such integral of
/// the matrix. Where the functions do not overlap the entry must be zero.
inline double worst_error(const BandMatrix& matrix, const QuadGramian& exact,
                          bool beside_largest = false) {
  Quad largest = 0;
  for (const Quad value : exact.absolutes) largest = std::max(largest, value);
  double worst = 0;
  for (int i = 0; i < exact.n; ++i) {
    for (int j = std::max(0, i - exact.p); j <= std::min(exact.n - 1, i + exact.p); ++j) {
      const Quad error = magnitude(Quad(matrix(i, j)) - exact.value(i, j));
      const Quad scale = beside_largest ? largest : exact.absolute(i, j);
      if (error == 0 || (scale != 0 && scale < smallest_compared)) continue;
      worst = std::max(worst, scale == 0 ? std::numeric_limits<double>::infinity()
                                         : static_cast<double>(error / scale));
    }
  }
  return worst;
}

}  // namespace knead::testing
