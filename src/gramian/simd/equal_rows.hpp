#pragma once

#include "kernels.hpp"
#include "lanes.hpp"

namespace knead::detail::KNEAD_ISA {

/// Rows are compared and copied in groups that fill a cache line.
inline constexpr int row_chunk = 8;

/// `equal_rows_begin` once the first spans are found to be equal.
template <int P>
__attribute__((noinline)) inline int equal_rows_found(const KernelKnots& knots, int end) {
  constexpr int K = P + 1;
  const double* x = knots.from(end);
  Lanes distance[K + 1];
  unrolled<1, K + 1>([&](auto k) KNEAD_LAMBDA { distance[k] = splat(x[k] - x[0]); });
  const auto same = [&](int row) KNEAD_LAMBDA {
    const double* at = knots.from(row);
    const Lanes here = load(at);
    auto differ = differs(load(at + 1) - here, distance[1]);
    unrolled<2, K + 1>([&](auto k)
                           KNEAD_LAMBDA { differ |= differs(load(at + k) - here, distance[k]); });
    return !any(differ);
  };
  for (int row = end; row < end + 2 * K + row_chunk; row += lanes) {
    if (!same(row)) return end;
  }
  int begin = end;
  for (; begin >= row_chunk; begin -= row_chunk) {
    bool all = true;
    unrolled<0, row_chunk / lanes>(
        [&](auto c) KNEAD_LAMBDA { all = all && same(begin - row_chunk + c * lanes); });
    if (!all) break;
  }
  return begin;
}

/// The rows from the result on down to `end` see the same distances d(i, k), k = 1 … p + 1, to the
/// last bit, as row `end` and all the rows that it depends on: then they are equal to that row, and
/// so are all intermediate results. The result is `end` minus a multiple of `row_chunk`, and `end`
/// itself if the rows differ.
template <int P>
KNEAD_INLINE int equal_rows_begin(const KernelKnots& knots, int end) {
  if (end < row_chunk || end >= knots.size - P - 1) return end;
  const double* x = knots.from(end);
  if (!(x[1] > x[0]) || x[2] - x[1] != x[1] - x[0]) return end;  // the usual case
  return equal_rows_found<P>(knots, end);
}

/// Copies row `end` to rows begin … end − 1, one diagonal at a time: all at once would need as many
/// store streams as there are diagonals.
template <int P>
inline void copy_rows(const KernelOutput& out, int begin, int end) {
  const auto fill = [&](double* diagonal) {
    const Lanes value = splat(diagonal[end]);
    for (int i = begin; i < end; i += row_chunk) {
      __builtin_prefetch(diagonal + i + 16 * row_chunk, 1);
      unrolled<0, row_chunk / lanes>([&](auto c)
                                         KNEAD_LAMBDA { store(diagonal + i + c * lanes, value); });
    }
  };
  for (int term = 0; term < 4; ++term) {
    for (int s = 0; s <= P; ++s) fill(out.g[term] + static_cast<std::size_t>(s) * out.stride[term]);
  }
  for (int s = 0; s < P; ++s) fill(out.lower10[s]);
}

}  // namespace knead::detail::KNEAD_ISA
