#pragma once

#include "kernels.hpp"
#include "lanes.hpp"

namespace knead::detail::KNEAD_ISA {

/// Gauss points for a degree known at compile time: a span per lane. p + 1 of them per span for all
/// terms; or, reduced, p + 1 for 00, p for 11 and 10 and p − 1 for 22, each a rule of its own.
///
/// First the matrices of `block` spans are computed, each the products of the p + 1 functions on
/// it; then row i of the band is the sum over the spans of its support, which are adjacent for
/// neighbouring rows. Tuned like the recurrence (registers, two reciprocals per division, the lower
/// half of G10 from the upper), so that the two can be compared.
template <int P, bool Reduced = false>
class FixedGauss {
  static constexpr int K = P + 1, entries = K * (K + 1) / 2;
  static constexpr int block = P <= 4 ? 64 : P <= 6 ? 32 : 16, width = block + 24;

 public:
  /// `points`: the rule, or the three with p + 1, p and p − 1 points.
  FixedGauss(const KernelKnots& knots, const KernelOutput& out, const GaussPoints* points)
      : knots_(knots), out_(out), points_(points), rows_(knots.size - K) {}

  void run() {
    // Column P + c of `local_` is span first + c; the P columns before are the last spans of the
    // previous block.
    for (int first = P; first - P < rows_; first += block) {
      reciprocals(first);
      for (int c = 0; c < block && first + c - P < rows_; c += lanes) span_group(first + c, c);
      const int end = first - P + block;
      add_up(first - P, end < rows_ ? end : rows_);
      for (auto& term : local_) {
        for (auto& entry : term) {
          for (int c = 0; c < P; ++c) entry[c] = entry[block + c];
        }
      }
    }
  }

 private:
  static constexpr int entry(int a, int b) { return a * K - a * (a - 1) / 2 + (b - a); }  // a <= b
  static constexpr int triangle(int q, int r) { return (q - 1) * q / 2 + r; }

  /// reciprocal_[q][c] = 1 / d(first − P + c, q), 0 for an empty support; two of them by one
  /// division.
  void reciprocals(int first) {
    for (int c = 0; c < block + P; c += lanes) {
      const double* x = knots_.from(first - P + c);
      const auto d = [&](int q) KNEAD_LAMBDA { return load(x + q) - load(x); };
      unrolled<2, P + 1>([&](auto q) KNEAD_LAMBDA {
        if constexpr (q % 2 == 0 && q < P) {
          const Lanes a = d(q), b = d(q + 1), safe = a > splat(0) ? a : splat(1),
                      both = 1.0 / (safe * b);
          store(reciprocal_[q] + c, where_positive(b * both, a));
          store(reciprocal_[q + 1] + c, where_positive(safe * both, b));
        } else if constexpr (q % 2 == 0) {
          store(reciprocal_[q] + c, where_positive(1.0 / d(q), d(q)));
        }
      });
    }
  }

  /// The local matrices of spans span, span + 1, … into columns P + c, P + c + 1, …
  __attribute__((noinline)) void span_group(int span, int c) {
    const double* x = knots_.from(span - P) + P;
    const Lanes a = load(x), b = load(x + 1);
    Lanes h = b - a;
    if (span + lanes > rows_) {  // spans past the domain do not count
      double length[8];
      store(length, h);
      for (int l = 0; l < lanes; ++l) length[l] = span + l < rows_ ? length[l] : 0;
      h = load(length);
    }
    const Lanes root = square_root(h);
    Lanes left[P + 1], right[P + 1], reciprocal[K * P / 2 + 1];
    unrolled<2, P + 1>([&](auto q) KNEAD_LAMBDA {
      left[q] = a - load(x + 1 - q);
      right[q] = load(x + q) - b;
      unrolled<0, q>([&](auto r) KNEAD_LAMBDA {
        reciprocal[triangle(q, r)] = load(reciprocal_[q] + c + P - q + 1 + r);
      });
    });
    if constexpr (P <= 2) reciprocal[0] = where_positive(1.0 / h, h);
    const Span at{h, root, left, right, reciprocal, P + c};
    if constexpr (Reduced) {
      sum_00(at);
      sum_11_and_10(at);
      sum_22(at);
    } else {
      sum_all(at);
    }
  }

  struct Span {
    Lanes h, root;
    const Lanes *left, *right, *reciprocal;
    int column;
  };

  /// f(g) for g = 0 … count − 1.
  template <int count, class F>
  KNEAD_INLINE static void for_points(F&& f) {
    if constexpr (P <= 4) {
      unrolled<0, count>(f);
    } else {
      for (int g = 0; g < count; ++g) f(g);
    }
  }

  /// f(i, j) for i <= j.
  template <class F>
  KNEAD_INLINE static void for_pairs(F&& f) {
    unrolled<0, K>([&](auto i)
                       KNEAD_LAMBDA { unrolled<i, K>([&](auto j) KNEAD_LAMBDA { f(i, j); }); });
  }

  KNEAD_INLINE void sum_all(const Span& at) {
    // Values, first and second derivatives, each times sqrt(h weight), at all points.
    Lanes values[K][K], slopes[K][K], bends[K][K];
    for_points<K>(
        [&](int g) KNEAD_LAMBDA { at_point(points_[0], g, at, values[g], slopes[g], bends[g]); });
    for_pairs([&](auto i, auto j) KNEAD_LAMBDA {
      Lanes g00 = values[0][i] * values[0][j], g11 = slopes[0][i] * slopes[0][j];
      Lanes g22 = bends[0][i] * bends[0][j], g10 = slopes[0][i] * values[0][j];
      unrolled<1, K>([&](auto g) KNEAD_LAMBDA {
        g00 = g00 + values[g][i] * values[g][j];
        g11 = g11 + slopes[g][i] * slopes[g][j];
        g22 = g22 + bends[g][i] * bends[g][j];
        g10 = g10 + slopes[g][i] * values[g][j];
      });
      const Lanes terms[4] = {g00, g11, g22, g10};
      for (int t = 0; t < 4; ++t) store(local_[t][entry(i, j)] + at.column, terms[t]);
    });
  }

  KNEAD_INLINE void sum_00(const Span& at) {
    Lanes values[K][K];
    for_points<K>([&](int g) KNEAD_LAMBDA { at_point(points_[0], g, at, values[g], none, none); });
    for_pairs([&](auto i, auto j) KNEAD_LAMBDA {
      Lanes g00 = values[0][i] * values[0][j];
      unrolled<1, K>([&](auto g) KNEAD_LAMBDA { g00 = g00 + values[g][i] * values[g][j]; });
      store(local_[0][entry(i, j)] + at.column, g00);
    });
  }

  KNEAD_INLINE void sum_11_and_10(const Span& at) {
    Lanes values[P][K], slopes[P][K];
    for_points<P>([&](int g)
                      KNEAD_LAMBDA { at_point(points_[1], g, at, values[g], slopes[g], none); });
    for_pairs([&](auto i, auto j) KNEAD_LAMBDA {
      Lanes g11 = slopes[0][i] * slopes[0][j], g10 = slopes[0][i] * values[0][j];
      unrolled<1, P>([&](auto g) KNEAD_LAMBDA {
        g11 = g11 + slopes[g][i] * slopes[g][j];
        g10 = g10 + slopes[g][i] * values[g][j];
      });
      store(local_[1][entry(i, j)] + at.column, g11);
      store(local_[3][entry(i, j)] + at.column, g10);
    });
  }

  KNEAD_INLINE void sum_22(const Span& at) {
    if constexpr (P > 1) {  // else zero, as it was made
      Lanes bends[P - 1][K];
      for_points<P - 1>([&](int g)
                            KNEAD_LAMBDA { at_point(points_[2], g, at, none, none, bends[g]); });
      for_pairs([&](auto i, auto j) KNEAD_LAMBDA {
        Lanes g22 = bends[0][i] * bends[0][j];
        unrolled<1, P - 1>([&](auto g) KNEAD_LAMBDA { g22 = g22 + bends[g][i] * bends[g][j]; });
        store(local_[2][entry(i, j)] + at.column, g22);
      });
    }
  }

  /// In place of what is not needed of a point.
  struct None {};
  static constexpr None none = {};

  /// Cox–de Boor from t and 1 − t; derivatives are differences of the intermediate lower degrees.
  template <class Values, class Slopes, class Bends>
  KNEAD_INLINE static void at_point(const GaussPoints& points, int g, const Span& span,
                                    Values values, Slopes slopes, Bends bends) {
    constexpr bool with_values = !std::is_same_v<Values, None>,
                   with_slopes = !std::is_same_v<Slopes, None>,
                   with_bends = !std::is_same_v<Bends, None>;
    constexpr int highest = with_values ? P : with_slopes ? P - 1 : P - 2;
    const double t = points.t[g], complement = points.complement[g];
    const Lanes forward = span.h * t, backward = span.h * complement,
                scale = span.root * points.root_weight[g];
    Lanes n[K], lower1[K], lower2[K], from_left[K], from_right[K];
    n[0] = scale * complement;
    n[1] = scale * t;
    if constexpr (P == 1) lower1[0] = scale;
    if constexpr (P == 2) lower2[0] = scale;
    if constexpr (P == 3 && highest == 1) lower2[0] = n[0], lower2[1] = n[1];
    from_left[1] = forward;
    from_right[1] = backward;
    unrolled<2, highest + 1>([&](auto q) KNEAD_LAMBDA {
      if constexpr (q == P) unrolled<0, q>([&](auto r) KNEAD_LAMBDA { lower1[r] = n[r]; });
      if constexpr (q == P - 1) unrolled<0, q>([&](auto r) KNEAD_LAMBDA { lower2[r] = n[r]; });
      from_left[q] = span.left[q] + forward;
      from_right[q] = span.right[q] + backward;
      Lanes saved = splat(0);
      unrolled<0, q>([&](auto r) KNEAD_LAMBDA {
        const Lanes quotient = n[r] * span.reciprocal[triangle(q, r)];
        n[r] = saved + from_right[r + 1] * quotient;
        saved = from_left[q - r] * quotient;
      });
      n[q] = saved;
    });
    if constexpr (highest == P - 2 && P > 3) {
      unrolled<0, P - 1>([&](auto r) KNEAD_LAMBDA { lower2[r] = n[r]; });
    }
    if constexpr (with_values) unrolled<0, K>([&](auto r) KNEAD_LAMBDA { values[r] = n[r]; });
    if constexpr (with_slopes) differentiate<P>(lower1, span.reciprocal, slopes);
    if constexpr (with_bends) {
      if constexpr (P == 1) {
        bends[0] = bends[1] = splat(0);
      } else {
        Lanes once[K];
        differentiate<P - 1>(lower2, span.reciprocal, once);
        differentiate<P>(once, span.reciprocal, bends);
      }
    }
  }

  /// One difference: coefficients on degree q − 1 (q of them) to degree q (q + 1 of them).
  template <int q>
  KNEAD_INLINE static void differentiate(const Lanes* lower, const Lanes* reciprocal,
                                         Lanes* result) {
    Lanes before = splat(0);
    unrolled<0, q>([&](auto r) KNEAD_LAMBDA {
      const Lanes quotient = lower[r] * (q * reciprocal[triangle(q, r)]);
      result[r] = r == 0 ? -quotient : before - quotient;
      before = quotient;
    });
    result[q] = before;
  }

  KNEAD_INLINE void add_up(int begin, int end) {
    for (int term = 0; term < 4; ++term) {
      unrolled<0, K>([&](auto s) KNEAD_LAMBDA {
        double* to = out_.g[term] + s * out_.stride[term];
        for (int i = begin; i < end; i += lanes) {
          Lanes sum = load(local_[term][entry(0, s)] + P + i - begin);
          unrolled<1, K - s>([&](auto a) KNEAD_LAMBDA {
            sum = sum + load(local_[term][entry(a, a + s)] + P + i - begin - a);
          });
          store(to + i, sum);
          if constexpr (s > 0) {
            if (term == 3) store(out_.lower10[s - 1] + i, -sum);
          }
        }
      });
    }
  }

  const KernelKnots& knots_;
  const KernelOutput& out_;
  const GaussPoints* const points_;
  const int rows_;
  double local_[4][entries][width] = {};
  double reciprocal_[K + 1][width] = {};
};

}  // namespace knead::detail::KNEAD_ISA
