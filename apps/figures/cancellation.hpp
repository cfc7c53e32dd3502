#pragma once

#include <array>

namespace knead::figures {

/// The cancellation in one entry of G00 by the Dirac rule, Σ_ξ weight(ξ) · integral(ξ), on the
/// thesis' knots.
struct Cancellation {
  double condition = 0;              ///< Σ|t| / |Σt|
  std::array<double, 2> weight{};    ///< Dirac weights of N_{p+5} at 6 and at 6 + 10^-r
  std::array<double, 2> integral{};  ///< (p + 1)-fold integrals of N_{p+5} there
  double plain = 0,
         kahan =
             0;  ///< relative errors of the sum of the terms, summed plainly and by Kahan's method
  double normalised = 0;  ///< the same with every knot divided by 13
  double mirrored = 0;    ///< the same with integrals from the right
};

/// The entry (p + 5, p + 5) of Tables 5.3, 5.7, 5.11, for any degree 1 to 15; the knots extend to
/// 13, or to p + 7 if the function needs them. The reference is `recurrence`, which the tests check
/// against quadruple precision.
[[nodiscard]] Cancellation cancellation(int degree, int r);

/// The largest relative error over all entries of G00 by the analytic method against recurrence: on
/// the thesis' knots, and with three knots 1e-8 apart, 6, 6 + 1e-8 and 6 + 2e-8, in place of 6
/// and 7.
[[nodiscard]] double worst_on_thesis_knots(int degree, int r);
/// The same with every entry taken from the left or from the right, whichever is more accurate.
[[nodiscard]] double worst_by_better_side(int degree, int r);
[[nodiscard]] double worst_on_cluster(int degree);

}  // namespace knead::figures
