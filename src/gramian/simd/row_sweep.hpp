#pragma once

#include "equal_rows.hpp"
#include "kernels.hpp"
#include "lanes.hpp"

namespace knead::detail::KNEAD_ISA {

/// Sweeps the rows of the Gramians downwards in groups of `lanes`, all levels of a group in
/// registers.
///
/// The values that a row needs from the next row are the same register shifted by one lane; the
/// incoming lane is row 0 of the previous group, kept in a carry. `Kernel` derives from this and
/// has `compute<Split>(x, out, row, wanted)`: the group of rows `row`, … from the knots at x, into
/// `out` where wanted, with repeated knots split where `Split`.
template <int P, class Kernel>
class RowSweep {
 protected:
  static constexpr int K = P + 1;

 public:
  static void run(const KernelKnots& knots, const KernelOutput& out) {
    Kernel kernel;
    const int rows = knots.size - K, last = (rows - 1) / lanes;
    // Rows past the last have no support of their own; they only fill the carries.
    for (int group = (rows + P) / lanes; group >= 0; --group) {
      const int end = (group + 1) * lanes;
      if (const int begin = equal_rows_begin<P>(knots, end); begin < end) {
        copy_rows<P>(out, begin, end);
        group = begin / lanes;
        kernel.empty_ = 0;  // the rows above are known to have no empty span
        continue;
      }
      const double* x = knots.from(group * lanes);
      if (kernel.near_empty_span(x)) {
        kernel.template compute<true>(x, out, group * lanes, group <= last);
      } else {
        kernel.template compute<false>(x, out, group * lanes, group <= last);
      }
    }
  }

 protected:
  /// One lane-wise quantity at the rows of the group and at the rows after them.
  struct Pair {
    Lanes here, next;
  };

  KNEAD_INLINE static Lanes next(Lanes value, double& carry) {
    const Lanes result = shifted(value, carry);
    carry = first(value);
    return result;
  }

  /// D(t)_s(i) = t_s(i) − t_{s+1}(i) − t_{s−1}(i+1) + t_s(i+1), t_{−1}(i+1) read as t_1(i), t_s
  /// zero from s = Count on.
  template <int s, int Count>
  KNEAD_INLINE static Lanes difference(const Pair* t) {
    if constexpr (s == 0) {
      const Lanes sum = t[0].here + t[0].next;
      if constexpr (Count > 1) return sum - (t[1].here + t[1].here);
      return sum;
    } else if constexpr (s + 1 < Count) {
      return (t[s].here - t[s + 1].here) + (t[s].next - t[s - 1].next);
    } else if constexpr (s < Count) {
      return t[s].here + (t[s].next - t[s - 1].next);
    } else if constexpr (s == Count) {
      return -t[s - 1].next;
    } else {
      return splat(0);
    }
  }

  /// Functions of lower order without support count as zero from here on.
  KNEAD_INLINE static void mask(const double* xp, Pair* t1, Pair* t2, Pair* cross, Lanes& rho) {
    Lanes z1[K + 1], z2[K + 1];  // 1 where d(i + s, p) > 0, d(i + s, p − 1) > 0
    unrolled<0, K>([&](auto s) KNEAD_LAMBDA {
      z1[s] = where_positive(splat(1), load(xp + s + P) - load(xp + s));
      z2[s] = where_positive(splat(1), load(xp + s + P - 1) - load(xp + s));
    });
    unrolled<0, P>([&](auto s) KNEAD_LAMBDA {
      t1[s].here = where_positive(t1[s].here, z1[0] * z1[s]);
      t1[s].next = where_positive(t1[s].next, z1[1] * z1[s + 1]);
      cross[s].here = where_positive(cross[s].here, z1[0]);
      cross[s].next = where_positive(cross[s].next, z1[1]);
    });
    unrolled<0, P - 1>([&](auto s) KNEAD_LAMBDA {
      t2[s].here = where_positive(t2[s].here, z2[0] * z2[s]);
      t2[s].next = where_positive(t2[s].next, z2[1] * z2[s + 1]);
    });
    rho = where_positive(rho, z1[0]);
  }

 private:
  /// Whether some span used by the group's rows, or by the rows they reach through the carries, has
  /// zero length. Groups are queried in order; earlier answers are remembered.
  bool near_empty_span(const double* x) {
    constexpr unsigned window = (1u << ((lanes + 2 * K - 2) / lanes + 1)) - 1;
    empty_ = (empty_ << 1) | (any_not_positive(load(x + 1) - load(x)) ? 1u : 0u);
    return (empty_ & window) != 0;
  }

  unsigned empty_ = ~0u;
};

}  // namespace knead::detail::KNEAD_ISA
