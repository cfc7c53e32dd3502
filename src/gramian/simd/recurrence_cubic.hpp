#pragma once

#include "kernels.hpp"
#include "lanes.hpp"
#include "row_sweep.hpp"

namespace knead::detail::KNEAD_ISA {

/// The positive recurrence for cubics, written out: `FixedRecurrence<3>` with equal and zero terms
/// eliminated by hand, ordered so that values are short-lived, and scaled from the start so that
/// G00 needs no factor at the end.
///
/// Sklm below is S[k][l][m](i), times the factor of G00; S4.. and S.4. carry the supports of the
/// functions of order 4.
class CubicRecurrence : public RowSweep<3, CubicRecurrence> {
  using Sweep = RowSweep<3, CubicRecurrence>;
  friend Sweep;

  static constexpr double factor00 = factors(3).g00, factor11 = factors(3).g11 / factor00,
                          factor22 = factors(3).g22 / factor00,
                          factor10 = factors(3).g10 / factor00;

  KNEAD_INLINE Pair paired(Lanes value, int carry) { return {value, next(value, carry_[carry])}; }

  template <bool Split>
  __attribute__((noinline)) void compute(const double* xp, const KernelOutput& out, int row,
                                         bool wanted) {
    const Lanes x0 = load(xp), x1 = load(xp + 1), x2 = load(xp + 2), x3 = load(xp + 3),
                x4 = load(xp + 4);
    const auto d = [](Lanes upper, Lanes lower, int knots_between) KNEAD_LAMBDA {
      const Lanes distance = upper - lower;
      if constexpr (Split) return distance + splat(knots_between * splitting);
      return distance;
    };

    // 1 / d(i, 2) and 1 / d(i, 3) by one division.
    const Lanes d02 = d(x2, x0, 2), d03 = d(x3, x0, 3), both = 1.0 / (d02 * d03);
    const Lanes r2 = d03 * both, r3 = d02 * both;
    const Pair s201 = paired(r2 * factor00, 0);
    const Lanes d01 = d(x1, x0, 1), d12 = d(x3, x1, 2), d11 = d(x2, x1, 1), d21 = d(x3, x2, 1);
    const Lanes w01 = d01 * r3, w12 = d12 * r3, w21 = d21 * r3,
                w11 = d11 * r2;  // the weights of orders 3 and 2

    const Pair s301 = paired(w01 * s201.here, 1), s302 = paired(w21 * s201.next, 2);
    const Pair s221 = paired(w11 * s201.next, 3);
    const Lanes d22 = d(x4, x2, 2), d31 = d(x4, x3, 1), d13 = d(x4, x1, 3);
    const Pair s401 = paired(d01 * s301.here, 4);
    const Lanes s402 = d22 * s301.next + d02 * s302.here, s403 = d31 * s302.next;
    const Lanes inner = w12 * s201.next;
    const Pair s311 = paired(inner + (s301.here + s302.here), 5);
    const Pair s230 = paired(s311.here + s221.here, 6);
    const Pair s231 = paired(w11 * s301.next, 7);
    const Pair s321 = paired((inner + inner) + (w01 * s221.here + s302.here), 8);
    const Pair s322 = paired(w21 * s221.next, 9);
    const Lanes s411 = d13 * s301.next + (d01 * s311.here + s402);
    const Lanes s412 = d22 * s311.next + (d02 * s302.here + s403);
    const Lanes d04 = d(x4, x0, 4);
    const Pair s240 = paired(s411 + d04 * s231.here, 10);
    const Pair s241 = paired(w11 * s401.next, 11);
    const Lanes s421 = d13 * s230.next + (d01 * s321.here + s412);
    const Lanes s422 = d22 * s321.next + (d02 * s322.here + s403), s423 = d31 * s322.next;
    const Pair s331 = paired(w12 * s230.next + (w01 * s231.here + s322.here), 12);
    const Pair s332 = paired(w21 * s231.next, 13);
    const Lanes x5 = load(xp + 5), x6 = load(xp + 6), d14 = d(x5, x1, 4), d24 = d(x6, x2, 4);
    const Pair s340 = paired(s421 + d04 * s331.here, 14);
    const Pair s341 = paired(w12 * s240.next + (w01 * s241.here + d14 * s332.here), 15);
    const Pair s342 = paired(w21 * s241.next, 16);
    const Lanes s431 = d13 * (s321.next + s321.next) + (d01 * s331.here + s422);
    const Lanes s432 = d22 * s331.next + (d02 * s332.here + s423), s433 = d31 * s332.next;

    // Exactly zero where supports do not overlap, whatever the splitting gave.
    const auto put = [&](int term, int s, Lanes value) KNEAD_LAMBDA {
      if constexpr (Split)
        value = s == 0 ? value : where_positive(value, x4 - (s == 1 ? x1 : s == 2 ? x2 : x3));
      store(out.g[term] + static_cast<std::size_t>(s) * out.stride[term] + row, value);
      if (term == 3 && s > 0) store(out.lower10[s - 1] + row, -value);
    };
    if (wanted) {
      const Lanes half = d04 * s431;
      put(0, 0, half + half);
      put(0, 1, d13 * s340.next + (d01 * s341.here + d14 * s432));
      put(0, 2, d22 * s341.next + (d02 * s342.here + d24 * s433));
      put(0, 3, d31 * s342.next);
    }

    // The first of t1 and of t2 is S330 and S220 without their factor 2.
    Pair t1[4] = {s321, s331, s332}, cross[4] = {s340, s341, s342};
    Pair t2[4] = {s201, s221};
    Lanes rho = r3;
    if constexpr (Split) mask(xp, t1, t2, cross, rho);
    const Lanes rho1 = next(rho, carry_[17]), rho2 = next(rho1, carry_[18]);
    const Lanes scaled = rho * factor22;
    const Lanes diagonal = (t2[0].here + t2[0].next) - t2[1].here;
    const Pair q0 = paired(scaled * rho * (diagonal + diagonal), 19);
    const Pair q1 =
        paired(scaled * rho1 * (t2[1].here + (t2[1].next - (t2[0].next + t2[0].next))), 20);
    const Pair q2 = paired(scaled * rho2 * -t2[1].next, 21);
    if (!wanted) return;
    const Pair q[4] = {q0, q1, q2};
    put(1, 0, ((t1[0].here + t1[0].next) - t1[1].here) * (2 * factor11));
    put(1, 1, ((t1[1].here - t1[2].here) + (t1[1].next - (t1[0].next + t1[0].next))) * factor11);
    put(1, 2, (t1[2].here + (t1[2].next - t1[1].next)) * factor11);
    put(1, 3, t1[2].next * -factor11);
    unrolled<0, 4>([&](auto s) KNEAD_LAMBDA { put(2, s, difference<s, 3>(q)); });
    Lanes edge = splat(0);  // half the jump of the square of a function
    if constexpr (Split)
      edge = 0.5 * (where_positive(splat(1), x3 - x0) - where_positive(splat(1), x4 - x1));
    put(3, 0, edge);
    put(3, 1, (cross[1].here - cross[0].next) * factor10);
    put(3, 2, (cross[2].here - cross[1].next) * factor10);
    put(3, 3, cross[2].next * -factor10);
  }

  double carry_[22] = {};
};

}  // namespace knead::detail::KNEAD_ISA
