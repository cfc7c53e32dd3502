#pragma once

#include "kernels.hpp"
#include "lanes.hpp"
#include "row_sweep.hpp"

namespace knead::detail::KNEAD_ISA {

/// The positive recurrence for a degree known at compile time; docs/gramians/recurrence.md derives
/// it.
///
/// S[k][l][s](i) is the scaled inner product of the functions (i, order k) and (i + s, order l), k
/// + l = m at level m. Rows of order K = p + 1 are stored multiplied by their support d(i, K),
/// which saves the division by it.
template <int P>
class FixedRecurrence : public RowSweep<P, FixedRecurrence<P>> {
  using Sweep = RowSweep<P, FixedRecurrence<P>>;
  static constexpr int K = P + 1;
  using typename Sweep::Pair;

  friend RowSweep<P, FixedRecurrence<P>>;

  template <bool Split>
  __attribute__((noinline)) void compute(const double* xp, const KernelOutput& out, int row,
                                         bool wanted) {
    Lanes x[K + 1];
    unrolled<0, K + 1>([&](auto b) KNEAD_LAMBDA { x[b] = load(xp + b); });
    const auto knot_distance = [&](Lanes upper, Lanes lower, int knots_between) KNEAD_LAMBDA {
      const Lanes distance = upper - lower;
      if constexpr (Split) return distance + splat(knots_between * splitting);
      return distance;
    };
    const auto d = [&](auto a, auto b) KNEAD_LAMBDA {
      return knot_distance(x[b], x[a], b - a);
    };                 // d(i + a, b − a)
    Lanes support[K];  // d(i + s, K)
    unrolled<0, K>([&](auto s)
                       KNEAD_LAMBDA { support[s] = knot_distance(load(xp + s + K), x[s], K); });

    Lanes reciprocal[K];  // 1 / d(i, k), two of them by one division
    unrolled<1, K>([&](auto k) KNEAD_LAMBDA {
      if constexpr (k == 1 && P != 2) {
      } else if constexpr (k > 1 && k % 2 == 0 && k + 1 < K) {
        const Lanes a = d(Index<0>(), Index<k>()), b = d(Index<0>(), Index<k + 1>()),
                    both = 1.0 / (a * b);
        reciprocal[k] = b * both;
        reciprocal[k + 1] = a * both;
      } else if constexpr (k == 1 || k % 2 == 0) {
        reciprocal[k] = 1.0 / d(Index<0>(), Index<k>());
      }
    });

    // The weights 1 − w = d(i, s)/d(i, k) and w = d(i + s, k − s)/d(i, k); for order K without the
    // division.
    Lanes below[K + 1][K], above[K + 1][K];
    unrolled<2, K + 1>([&](auto k) KNEAD_LAMBDA {
      unrolled<1, k>([&](auto s) KNEAD_LAMBDA {
        if constexpr (s <= k - 2) {
          below[k][s] = k < K ? d(Index<0>(), s) * reciprocal[k < K ? k : 1] : d(Index<0>(), s);
        }
        above[k][s] = k < K ? d(s, k) * reciprocal[k < K ? k : 1] : d(s, k);
      });
    });

    Pair level[2][K + 1][K];  // of two consecutive m
    Pair t1[K], t2[K], cross[K];
    Lanes full[K];
    unrolled<2, 2 * K + 1>([&](auto m_) KNEAD_LAMBDA {
      constexpr int m = m_;
      auto& now = level[m % 2];
      auto& before = level[(m + 1) % 2];
      unrolled<0, K>([&](auto k_) KNEAD_LAMBDA {
        constexpr int
            k = K - k_,
            l = m - k;  // k decreases, so that S[l][k] is known when S[k][l], k < l, is needed
        if constexpr (l >= 0 && l <= K && !(k == 1 && l == 0)) {
          unrolled<0, k>([&](auto s_) KNEAD_LAMBDA {
            constexpr int s = s_;
            if constexpr ((l == 0 && s == 0) || (k == K && l < K && s == 0)) {
              return;  // zero, and never needed
            } else if constexpr (k == 1 && l == 1 && P != 2) {
              return;
            } else if constexpr (k < l && l < K && s == 0) {
              now[k][0] = now[l][0];
            } else if constexpr (l == 1 && k > 1 && (s == 0 || s == k - 1)) {
              now[k][s] = before[k][s == 0 ? 1 : s];
            } else {
              Lanes v;
              if constexpr (k == 1 && l == 1) {
                v = reciprocal[1];
              } else if constexpr (k == 2 && l == 0) {
                v = K == 2 ? splat(1) : reciprocal[2];
              } else if constexpr (s == 0) {
                v = diagonal<k, l>(before, support[0]);
              } else {
                // Else both (i, order k − 1) and (i + s + 1) end before they meet.
                constexpr bool inner = s <= k - 2;
                bool any = false;
                const auto add = [&](Lanes term) KNEAD_LAMBDA {
                  v = any ? v + term : term;
                  any = true;
                };
                if constexpr (inner && l >= 1) {
                  add(l == K ? before[k][s + 1].here * support[s] : before[k][s + 1].here);
                }
                if constexpr (inner) {
                  add(below[k][s] * before[k - 1][s].here);
                }
                if constexpr (!(l == 0 && s == 1)) {
                  add(above[k][s] * before[k - 1][s - 1].next);
                }
              }
              now[k][s].here = v;
              if constexpr (k < K) now[k][s].next = Sweep::next(v, carry_[k][l][s]);
            }
            if constexpr (k == P - 1 && l == P - 1) t2[s] = now[k][s];
            if constexpr (k == P && l == P) t1[s] = now[k][s];
            if constexpr (k == P && l == K) cross[s] = now[k][s];
            if constexpr (k == K && l == K) full[s] = now[k][s].here;
          });
        }
      });
    });

    Lanes rho = reciprocal[P];
    if constexpr (Split) Sweep::mask(xp, t1, t2, cross, rho);
    Pair q[K];
    weighted_differences(t2, rho, q);
    if (!wanted) return;
    // Exactly zero where supports do not overlap, whatever the splitting gave.
    const auto put = [&](double* at, auto s, Lanes value) KNEAD_LAMBDA {
      if constexpr (Split && s > 0) value = where_positive(value, x[K] - x[s]);
      store(at, value);
    };
    constexpr Factors factor = factors(P);
    unrolled<0, K>([&](auto s) KNEAD_LAMBDA {
      const auto at = [&](int term)
                          KNEAD_LAMBDA { return out.g[term] + s * out.stride[term] + row; };
      put(at(0), s, full[s] * (s == 0 ? 2 * factor.g00 : factor.g00));
      put(at(1), s, Sweep::template difference<s, P>(t1) * factor.g11);
      put(at(2), s, Sweep::template difference<s, P>(q));
      if constexpr (s == 0) {
        // (z_i − z_{i+1}) / 2: where a function jumps, half the jump of its square.
        Lanes edge = splat(0);
        if constexpr (Split) {
          edge =
              0.5 * (where_positive(splat(1), x[P] - x[0]) - where_positive(splat(1), x[K] - x[1]));
        }
        store(at(3), edge);
      } else {
        Lanes value = s < P ? cross[s].here - cross[s - 1].next : -cross[s - 1].next;
        value = value * factor.g10;
        put(at(3), s, value);
        put(out.lower10[s - 1] + row, s, -value);
      }
    });
  }

  /// S[k][l][0] = S[l][k-1][1] + S[k][l-1][1], with the supports that orders K carry.
  template <int k, int l>
  KNEAD_INLINE static Lanes diagonal(const Pair (&before)[K + 1][K], Lanes support) {
    if constexpr (k == K && l == K) {
      return support * before[K][1].here;  // twice this; the factor waits for the output
    } else if constexpr (k == 1) {
      return before[l][1].here;
    } else if constexpr (l == K) {
      return before[l][1].here + support * before[k][1].here;
    } else {
      return before[l][1].here + before[k][1].here;
    }
  }

  /// Q_s(i) = rho_i rho_{i+s} D(t)_s(i): inner products of the first derivatives of the functions
  /// of order p.
  KNEAD_INLINE void weighted_differences(const Pair* t, Lanes rho, Pair* q) {
    Lanes ahead = rho;
    const Lanes scaled = rho * factors(P).g22;
    unrolled<0, P>([&](auto s) KNEAD_LAMBDA {
      if constexpr (s > 0) ahead = Sweep::next(ahead, carry_rho_[s]);
      q[s].here = (scaled * ahead) * Sweep::template difference<s, P - 1>(t);
      q[s].next = Sweep::next(q[s].here, carry_q_[s]);
    });
  }

  double carry_[K + 1][K + 1][K] = {};
  double carry_rho_[K] = {}, carry_q_[K] = {};
};

/// Degree 1 in closed form.
template <>
class FixedRecurrence<1> {
 public:
  static void run(const KernelKnots& knots, const KernelOutput& out) {
    for (int i = 0; i < knots.size - 2; i += lanes) {
      const double* x = knots.from(i);
      const Lanes a = load(x + 1) - load(x), b = load(x + 2) - load(x + 1);
      const Lanes slope_a = where_positive(1.0 / a, a), slope_b = where_positive(1.0 / b, b);
      const Lanes half_a = where_positive(splat(0.5), a), half_b = where_positive(splat(0.5), b);
      const auto at = [&](int term, std::size_t s) {
        return out.g[term] + s * out.stride[term] + i;
      };
      store(at(0, 0), (a + b) / 3.0);
      store(at(0, 1), b / 6.0);
      store(at(1, 0), slope_a + slope_b);
      store(at(1, 1), -slope_b);
      store(at(2, 0), splat(0));
      store(at(2, 1), splat(0));
      store(at(3, 0), half_a - half_b);
      store(at(3, 1), -half_b);
      store(out.lower10[0] + i, half_b);
    }
  }
};

}  // namespace knead::detail::KNEAD_ISA
