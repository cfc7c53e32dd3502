#pragma once

#include <array>
#include <vector>

#include "knead/gramian/gramian.hpp"

namespace knead::lab {

inline constexpr std::array<GramianMethod, 3> compared_methods{
    GramianMethod::gauss, GramianMethod::analytic, GramianMethod::recurrence};
/// Which methods are subtracted from which, as indices of `compared_methods`.
inline constexpr std::array<std::array<int, 2>, 3> compared_pairs{{{0, 2}, {1, 2}, {1, 0}}};

/// The largest entry of a difference and its position; −1 if all entries agree.
struct WorstEntry {
  double absolute = 0, relative = 0;
  int absolute_row = -1, absolute_column = -1, relative_row = -1, relative_column = -1;
};

/// One Gramian by every method. A table is a band, row by row: entry (i, j), |i − j| <= p, at i (2p
/// + 1) + j − i + p, zero outside the matrix.
struct Comparison {
  int size = 0, half_bandwidth = 0;
  std::array<GramianMethod, 3> used;  ///< the method that computed it: see `used_gramian_method`
  std::array<std::vector<double>, 3> values;       ///< per method
  std::vector<double> absolute_integral;           ///< ∫|N_i^(a) N_j^(b)|
  std::array<std::vector<double>, 3> differences;  ///< per pair
  std::array<std::vector<double>, 3>
      relative;  ///< |difference| / ∫|N_i^(a) N_j^(b)|; 0 where both are zero
  std::array<WorstEntry, 3> worst;
};

/// Errors: those of `gramian`. Quadrature errors are measured against the absolute integral; it
/// uses p + 1 Gauss points on each of 2 to 16 equal pieces of a span (fewer if there are many
/// spans), is exact where the product has one sign on a piece, and accurate to a few percent
/// elsewhere.
[[nodiscard]] Expected<Comparison> compare_gramians(const KnotVector& knots, int a, int b);

/// Seconds per Gramian for each of `compared_methods`: the mean over as many runs as fit into
/// `budget` seconds per method, at least one.
[[nodiscard]] Expected<std::array<double, 3>> time_gramians(const KnotVector& knots, int a, int b,
                                                            double budget);

}  // namespace knead::lab
