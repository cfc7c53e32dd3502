#pragma once

#include "equal_rows.hpp"
#include "kernels.hpp"
#include "lanes.hpp"

namespace knead::detail::KNEAD_ISA {

/// The positive recurrence for cubics, written out: `FixedRecurrence<3>` with equal and zero terms
/// eliminated by hand, and scaled from the start so that G00 needs no factor at the end.
///
/// The rows are swept downwards in blocks, and a block in three stages and then diagonal by
/// diagonal, each a loop over its rows: a stage reads row i + 1 only of values that an earlier
/// stage has left in the block's table. So "i + 1" is a load from the next place, no row waits for
/// the previous one, and a stage needs few registers.
///
/// Sklm below is S[k][l][m](i), times the factor of G00; S4.. and S.4. carry the supports of the
/// functions of order 4.
class BlockedCubicRecurrence {
  static constexpr int P = 3, K = 4, block = 48, chunk = row_chunk;

  static constexpr double factor00 = factors(3).g00, factor11 = factors(3).g11 / factor00,
                          factor22 = factors(3).g22 / factor00,
                          factor10 = factors(3).g10 / factor00;

  /// D1 … D4 are the distances d(i, k), R2 and R3 the reciprocals of two of them, W.. the weights
  /// of order 3, Half one half of S440, Q. the inner products of the first derivatives of
  /// quadratics. D1 … R3 are needed beyond i + 1.
  enum Quantity {
    // clang-format off
    D1, D2, D4, R3, D3, R2, W01, S201, S301,                            // of stage 0
    W12, W21, S302, S221, S311, S231, S321, S330, S241, S240, Q0,       // of stage 1
    S331, S332, S340, S341, S342, S322, Half, Q1, Q2,                   // of stage 2
    quantities
    // clang-format on
  };
  /// For scalars, the quantities of a row are adjacent, as processors combine adjacent stores;
  /// vectors need the rows adjacent.
  static constexpr int width = 37;

 public:
  static void run(const KernelKnots& knots, const KernelOutput& out) {
    BlockedCubicRecurrence(knots, out).sweep();
  }

 private:
  BlockedCubicRecurrence(const KernelKnots& knots, const KernelOutput& out)
      : knots_(knots), out_(out), rows_(knots.size - K) {
    // The values past the uppermost block; the rest is written before it is read.
    for (int q = 0; q < width; ++q) {
      for (int c = block; c < block + 2 * chunk; c += lanes) store(at(q, c), splat(0));
    }
  }

  void sweep() {
    // Rows past the last have no support of their own; they only fill the table.
    for (int end = (rows_ + K + lanes - 1) / lanes * lanes; end > 0;) {
      if (const int begin = equal_rows_begin<P>(knots_, end); begin < end) {
        copy_rows<P>(out_, begin, end);
        end = begin;
        continue;
      }
      // Chunks of rows near an empty span and others are not mixed in one block.
      int begin = (end - 1) / chunk * chunk;  // only the uppermost chunk is not full
      bool above = empty_span(begin + chunk), here = empty_span(begin);
      const bool split = above || here;
      while (begin > 0 && end - begin + chunk <= block) {
        above = here;
        here = empty_span(begin - chunk);
        if ((above || here) != split) break;
        begin -= chunk;
      }
      if (split) {
        compute<true>(begin, end);
      } else {
        compute<false>(begin, end);
      }
      end = begin;
    }
  }

  template <bool Split>
  __attribute__((noinline)) void compute(int begin, int end) {
    // Row i is in column i + shift; the row after the block in column `block`, where the previous
    // block left it.
    const int shift = block - end, stop = end < rows_ ? end : rows_;
    for (int row = begin; row < end; row += chunk) {
      if (row < stop) fetch<0>(row);
      const double* x = knots_.from(row);
      for (int i = row; i < chunk_end<Split>(row, end); i += lanes)
        stage0<Split>(x + (i - row), i + shift);
    }
    for (int row = begin; row < end; row += chunk) {
      if (row < stop) fetch<1>(row);
      for (int i = row; i < chunk_end<Split>(row, end); i += lanes) stage1<Split>(i, i + shift);
    }
    for (int row = begin; row < end; row += chunk) {
      if (row < stop) fetch<2>(row);
      for (int i = row; i < chunk_end<Split>(row, end); i += lanes) stage2<Split>(i, i + shift);
    }
    unrolled<0, K>([&](auto s) KNEAD_LAMBDA {
      const auto to = [&](int term) KNEAD_LAMBDA {
        return out_.g[term] + static_cast<std::size_t>(s) * out_.stride[term];
      };
      double *to00 = to(0), *to11 = to(1), *to22 = to(2), *to10 = to(3),
             *lower10 = s > 0 ? out_.lower10[s > 0 ? s - 1 : 0] : nullptr;
      each_row(begin, stop,
               [&](int row) KNEAD_LAMBDA { put<Split, s>(to00, row, entry00<s>(row + shift)); });
      each_row(begin, stop, [&](int row) KNEAD_LAMBDA {
        put<Split, s>(to11, row, entry11<Split, s>(row, row + shift));
      });
      each_row(begin, stop,
               [&](int row) KNEAD_LAMBDA { put<Split, s>(to22, row, entry22<s>(row + shift)); });
      each_row(begin, stop, [&](int row) KNEAD_LAMBDA {
        const Lanes value = entry10<Split, s>(row, row + shift);
        put<Split, s>(to10, row, value);
        if constexpr (s > 0) put<Split, s>(lower10, row, -value);
      });
    });
    for (int q = 0; q < quantities; ++q) {
      const int count = q <= R3 ? K : 1;
      for (int c = 0; c < count; c += lanes)
        store(at(q, block + c), load(at(q, begin + shift + c)));
    }
  }

  /// Prefetches a third of the lines to which a chunk will be written while the block is computed.
  template <int third>
  KNEAD_INLINE void fetch(int row) const {
    const auto ask = [&](int term, int s) KNEAD_LAMBDA {
      __builtin_prefetch(out_.g[term] + static_cast<std::size_t>(s) * out_.stride[term] + row, 1);
    };
    unrolled<0, K>([&](auto s) KNEAD_LAMBDA {
      ask(third, s);
      if (s < 2 && third < 2) ask(3, 2 * third + s);
    });
    if constexpr (third == 2) {
      unrolled<0, P>([&](auto s) KNEAD_LAMBDA { __builtin_prefetch(out_.lower10[s] + row, 1); });
    }
  }

  /// The uppermost chunk, which may be cut short, uses the repeated knots past the last.
  template <bool Split>
  KNEAD_INLINE static int chunk_end(int row, int end) {
    return Split && end < row + chunk ? end : row + chunk;
  }

  /// Whole chunks: past the last row there is room for them.
  template <class F>
  KNEAD_INLINE static void each_row(int begin, int end, F&& f) {
    for (int row = begin; row < end; row += chunk) {
      unrolled<0, chunk / lanes>([&](auto k) KNEAD_LAMBDA { f(row + k * lanes); });
    }
  }

  /// Whether one of the spans that begin at knots row, …, row + chunk − 1 has zero length.
  [[nodiscard]] KNEAD_INLINE bool empty_span(int row) const {
    const double* x = knots_.from(row);
    bool found = false;
    unrolled<0, chunk / lanes>([&](auto c) KNEAD_LAMBDA {
      found |= any_not_positive(load(x + c * lanes + 1) - load(x + c * lanes));
    });
    return found;
  }

  template <bool Split>
  KNEAD_INLINE void stage0(const double* x, int c) {
    const Lanes x0 = load(x);
    const auto d = [&](int k) KNEAD_LAMBDA {
      const Lanes distance = load(x + k) - x0;
      if constexpr (Split) return distance + splat(k * splitting);
      return distance;
    };
    const Lanes d1 = d(1), d2 = d(2), d3 = d(3);
    set(D1, c, d1);
    set(D2, c, d2);
    set(D3, c, d3);
    set(D4, c, d(4));
    // 1 / d(i, 2) and 1 / d(i, 3) by one division.
    const Lanes both = 1.0 / (d2 * d3), r2 = d3 * both, r3 = d2 * both;
    const Lanes s201 = r2 * factor00, w01 = d1 * r3, s301 = w01 * s201;
    set(S201, c, s201);
    set(S301, c, s301);
    set(W01, c, w01);
    set(R2, c, r2);
    set(R3, c, r3);
  }

  template <bool Split>
  KNEAD_INLINE void stage1(int row, int c) {
    const Lanes s201_next = ahead<1>(S201, c), s301_next = ahead<1>(S301, c), s301 = get(S301, c);
    const Lanes d01 = get(D1, c), d02 = get(D2, c), d22 = ahead<2>(D2, c), d13 = ahead<1>(D3, c),
                d04 = get(D4, c);
    const Lanes r3 = get(R3, c), w12 = r3 * ahead<1>(D2, c), w21 = r3 * ahead<2>(D1, c);
    const Lanes w01 = get(W01, c), d11 = ahead<1>(D1, c), w11 = get(R2, c) * d11,
                inner = w12 * s201_next;
    set(W12, c, w12);
    set(W21, c, w21);
    const Lanes s302 = w21 * s201_next, s221 = w11 * s201_next, s231 = w11 * s301_next;
    set(S302, c, s302);
    set(S221, c, s221);
    set(S231, c, s231);
    const Lanes s402 = d22 * s301_next + d02 * s302;
    const Lanes s311 = inner + (s301 + s302);
    set(S311, c, s311);
    const Lanes s321 = (inner + inner) + (w01 * s221 + s302);
    set(S321, c, s321);
    set(S330, c, s321 + s321);
    set(S241, c, w11 * (d11 * s301_next));
    set(S240, c, d13 * s301_next + (d01 * s311 + s402) + d04 * s231);
    // The factor 2 of the diagonal difference is in the constant.
    Lanes t0 = get(S201, c), t0_next = s201_next, t1 = s221;
    if constexpr (Split) {
      t0 = kept(t0, row, 2, 0, 0);
      t0_next = kept(t0_next, row, 2, 1, 1);
      t1 = kept(t1, row, 2, 0, 1);
    }
    Lanes q0 = (r3 * (2 * factor22)) * r3 * ((t0 + t0_next) - t1);
    if constexpr (Split) q0 = kept(q0, row, 3, 0, 0);
    set(Q0, c, q0);
  }

  template <bool Split>
  KNEAD_INLINE void stage2(int row, int c) {
    const Lanes d01 = get(D1, c), d02 = get(D2, c), d22 = ahead<2>(D2, c), d13 = ahead<1>(D3, c);
    const Lanes d04 = get(D4, c), d14 = ahead<1>(D4, c), w01 = get(W01, c), w12 = get(W12, c),
                w21 = get(W21, c);
    const Lanes s302 = get(S302, c), s231 = get(S231, c), s311_next = ahead<1>(S311, c);
    const Lanes s221_next = ahead<1>(S221, c), s230_next = s311_next + s221_next;
    const Lanes s403 = ahead<3>(D1, c) * ahead<1>(S302, c), s322 = w21 * s221_next,
                s332 = w21 * ahead<1>(S231, c);
    set(S322, c, s322);
    set(S332, c, s332);
    const Lanes s412 = d22 * s311_next + (d02 * s302 + s403);
    const Lanes s331 = w12 * s230_next + (w01 * s231 + s322);
    set(S331, c, s331);
    const Lanes s421 = d13 * s230_next + (d01 * get(S321, c) + s412);
    set(S340, c, s421 + d04 * s331);
    set(S342, c, w21 * ahead<1>(S241, c));
    set(S341, c, w12 * ahead<1>(S240, c) + (w01 * get(S241, c) + d14 * s332));
    const Lanes s422 = d22 * ahead<1>(S321, c) + (d02 * s322 + s403);
    const Lanes s431 = d13 * ahead<1>(S330, c) + (d01 * s331 + s422), half = d04 * s431;
    set(Half, c, half);

    Lanes t0_next = ahead<1>(S201, c), t1 = get(S221, c), t1_next = s221_next;
    if constexpr (Split) {
      t0_next = kept(t0_next, row, 2, 1, 1);
      t1 = kept(t1, row, 2, 0, 1);
      t1_next = kept(t1_next, row, 2, 1, 2);
    }
    const Lanes scaled = get(R3, c) * factor22;
    Lanes q1 = scaled * ahead<1>(R3, c) * (t1 + (t1_next - (t0_next + t0_next)));
    Lanes q2 = scaled * ahead<2>(R3, c) * -t1_next;
    if constexpr (Split) {
      q1 = kept(q1, row, 3, 0, 1);
      q2 = kept(q2, row, 3, 0, 2);
    }
    set(Q1, c, q1);
    set(Q2, c, q2);
  }

  template <int s>
  [[nodiscard]] KNEAD_INLINE Lanes entry00(int c) const {
    if constexpr (s == 0) {
      return get(Half, c) + get(Half, c);
    } else if constexpr (s == 1) {
      const Lanes s423 = ahead<3>(D1, c) * ahead<1>(S322, c);
      const Lanes s432 = ahead<2>(D2, c) * ahead<1>(S331, c) + (get(D2, c) * get(S332, c) + s423);
      return ahead<1>(D3, c) * ahead<1>(S340, c) +
             (get(D1, c) * get(S341, c) + ahead<1>(D4, c) * s432);
    } else if constexpr (s == 2) {
      const Lanes s433 = ahead<3>(D1, c) * ahead<1>(S332, c);
      return ahead<2>(D2, c) * ahead<1>(S341, c) +
             (get(D2, c) * get(S342, c) + ahead<2>(D4, c) * s433);
    } else {
      return ahead<3>(D1, c) * ahead<1>(S342, c);
    }
  }

  template <bool Split, int s>
  [[nodiscard]] KNEAD_INLINE Lanes entry11(int row, int c) const {
    // S33s(i + n), zero where one of the functions of order 3 has no support
    const auto t = [&](Quantity q, auto n, int a) KNEAD_LAMBDA {
      Lanes value = ahead<n>(q, c);
      if constexpr (Split) value = kept(value, row, 3, n, n + a);
      return value;
    };
    constexpr Index<0> here;
    constexpr Index<1> next;
    if constexpr (s == 0) {
      return ((t(S321, here, 0) + t(S321, next, 0)) - t(S331, here, 1)) *
             (2 * factor11);  // S330 is twice S321
    } else if constexpr (s == 1) {
      return ((t(S331, here, 1) - t(S332, here, 2)) + (t(S331, next, 1) - t(S330, next, 0))) *
             factor11;
    } else if constexpr (s == 2) {
      return (t(S332, here, 2) + (t(S332, next, 2) - t(S331, next, 1))) * factor11;
    } else {
      return t(S332, next, 2) * -factor11;
    }
  }

  template <int s>
  [[nodiscard]] KNEAD_INLINE Lanes entry22(int c) const {
    if constexpr (s == 0) {
      return (get(Q0, c) + ahead<1>(Q0, c)) - (get(Q1, c) + get(Q1, c));
    } else if constexpr (s == 1) {
      return (get(Q1, c) - get(Q2, c)) + (ahead<1>(Q1, c) - ahead<1>(Q0, c));
    } else if constexpr (s == 2) {
      return get(Q2, c) + (ahead<1>(Q2, c) - ahead<1>(Q1, c));
    } else {
      return -ahead<1>(Q2, c);
    }
  }

  template <bool Split, int s>
  [[nodiscard]] KNEAD_INLINE Lanes entry10(int row, int c) const {
    const auto t = [&](Quantity q, auto n) KNEAD_LAMBDA {
      Lanes value = ahead<n>(q, c);
      if constexpr (Split) value = kept(value, row, 3, n, n);
      return value;
    };
    constexpr Index<0> here;
    constexpr Index<1> next;
    if constexpr (s == 0) {
      // Half the jump of the square of a function.
      if constexpr (Split)
        return 0.5 * (kept(splat(1), row, 3, 0, 0) - kept(splat(1), row, 3, 1, 1));
      return splat(0);
    } else if constexpr (s == 1) {
      return (t(S341, here) - t(S340, next)) * factor10;
    } else if constexpr (s == 2) {
      return (t(S342, here) - t(S341, next)) * factor10;
    } else {
      return t(S342, next) * -factor10;
    }
  }

  /// The inner product of functions (i + a, order k) and (i + b, order k), zero where one of them
  /// has no support.
  [[nodiscard]] Lanes kept(Lanes value, int row, int k, int a, int b) const {
    const double* x = knots_.from(row);
    return where_positive(where_positive(value, load(x + a + k) - load(x + a)),
                          load(x + b + k) - load(x + b));
  }

  /// Exactly zero where supports do not overlap, whatever the splitting gave.
  template <bool Split, int s>
  KNEAD_INLINE void put(double* to, int row, Lanes value) const {
    if constexpr (Split && s > 0) {
      const double* x = knots_.from(row);
      value = where_positive(value, load(x + K) - load(x + s));
    }
    store(to + row, value);
  }

  [[nodiscard]] KNEAD_INLINE double* at(int q, int c) { return table_ + offset(q, c); }
  [[nodiscard]] KNEAD_INLINE const double* at(int q, int c) const { return table_ + offset(q, c); }
  [[nodiscard]] KNEAD_INLINE static int offset(int q, int c) {
    return lanes == 1 ? c * width + q : q * (block + 2 * chunk) + c;
  }
  [[nodiscard]] KNEAD_INLINE Lanes get(Quantity q, int c) const { return load(at(q, c)); }
  /// The same for row i + n.
  template <int n>
  [[nodiscard]] KNEAD_INLINE Lanes ahead(Quantity q, int c) const {
    return load(at(q, c + n));
  }
  KNEAD_INLINE void set(Quantity q, int c, Lanes value) { store(at(q, c), value); }

  const KernelKnots& knots_;
  const KernelOutput out_;
  const int rows_;
  alignas(64) double table_[width * (block + 2 * chunk)];
};

}  // namespace knead::detail::KNEAD_ISA
