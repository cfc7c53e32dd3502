#pragma once

#include <span>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead {

/// A spline on fewer knots.
template <int D>
struct KnotRemoval {
  Spline<D> spline;
  std::vector<Points> companions;  ///< on the new net, in the order they were given
  std::vector<double> removed;     ///< knots that were removed, ascending, repeated if removed more than once
  /// Bound on the movement of any point of the spline or a companion, in units of the coordinates; zero if nothing was
  /// removed.
  double error_bound = 0;
};

/// Removes knots strictly inside the domain of one direction while no point S(u) moves by more than `tolerance`.
///
/// Greedy: the knot whose removal needs the smallest change goes first. The coefficients possible without one knot are
/// those c̃ with ℓᵀ c̃ = 0 for a single vector ℓ of alternating signs (a jump of a derivative); the smallest change in
/// the maximum norm is ℓᵀc sign(ℓ_i) w_i / Σ |ℓ_i| w_i, which is used (w_i the weights, 1 without). The first and last
/// rows of the net stay bit for bit, and so do all rows unaffected by removed knots. Cf. Lyche &
/// Mørken 1987, *The NURBS Book* 5.4.
///
/// The bound is certified against the given spline, not accumulated: the result is refined back (`Refinement`) and
/// compared coefficient by coefficient, |S − S̃| <= max_i |P_i − P̃_i|; with weights
/// max_i (w̃_i |P_i − P̃_i| + |w_i − w̃_i| r_i) / w_i, where r_i is the largest distance of P_i from the box of the new
/// net. It includes an allowance for rounding of 16 (p + 2) ulp of the largest coordinate, so a tolerance below that
/// removes nothing. Not promised: that no other choice removes more knots.
///
/// \param companions control points on the same net (a rest shape, a displacement) that must keep their shapes to the
///                   same tolerance; with the weights of the spline where it has them.
/// Cost: O(size p) for each interior knot and knot removed.
/// Errors (input): the tolerance is negative or not finite; a companion does not fit the net or is not finite; a weight
/// that is not positive.
template <int D>
[[nodiscard]] Expected<KnotRemoval<D>> remove_knots(const Spline<D>& spline, int direction, double tolerance,
                                                    std::span<const Points> companions = {});

}  // namespace knead
