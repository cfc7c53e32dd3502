#pragma once

#include <cstdint>
#include <vector>

#include "knead/spline/knot_vector.hpp"

namespace knead::lab {

/// All basis functions of a knot vector, sampled for drawing: derivatives, or repeated integrals.
struct Curves {
  /// (u, value) of one function after the other. Knots occur twice, with the limits from the left
  /// and the right: where a function jumps, two consecutive points have the same u.
  std::vector<double> points;
  /// Function i has the points offsets[i] … offsets[i + 1] − 1.
  std::vector<std::int32_t> offsets;
  /// (function, knot, k, weight): the term `weight` δ_knot^(k) of the derivative, as a distribution
  /// on the whole line.
  std::vector<double> impulses;
  double lowest = 0, highest = 0;  ///< of the values that are finite, and zero
  double largest_weight = 0;       ///< of the impulses δ themselves, k = 0
  /// Order 0: the largest |Σ N_i − 1| at nine points of every span of the domain.
  double unity = 0;
};

/// The functions on the whole range of the knots, which for clamped knots is the domain.
///
/// \param order  d >= 0: N_i^(d), piece by piece, with the impulses that the jumps of lower
/// derivatives leave behind,
///               N_i^(d) = {N_i^(d)} + Σ_ξ Σ_{k<d} [N_i^(d−1−k)]_ξ δ_ξ^(k) (spline/basis.hpp).
///               d < 0: the |d|-fold integral from −∞ (`basis_integral`), drawn to the end of the
///               range.
/// \param pixels width of the picture, which limits the number of points.
/// Values are those of `basis_function` and `basis_integral`, to the bit. Cost: O(n p³) and a small
/// factor of pixels.
[[nodiscard]] Curves sample_curves(const KnotVector& knots, int order, int pixels);

/// Values of all functions at u, order as above, the limit from the right at jumps.
[[nodiscard]] std::vector<double> values_at(const KnotVector& knots, int order, double u);

}  // namespace knead::lab
