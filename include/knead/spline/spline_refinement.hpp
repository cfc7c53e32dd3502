#pragma once

#include <array>
#include <vector>

#include "knead/spline/knot_refinement.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// The same function on finer knots in one direction.
///
/// c̃ = R c along that direction; with weights on homogeneous coordinates, w̃ = R w and P̃ = R (w P) / w̃. Neither shape
/// nor parametrisation change, up to rounding: with positive weights points move by less than 24 (p + 1) ulp of the
/// largest coordinate of the net, evaluation before and after included, whatever the ratio of the weights. Control
/// points and weights of `Refinement::copied` rows keep their bits. A displacement or a rest shape on the same net is
/// refined as a spline of its own: `refined(*spline.with_control_points(displacement), …)`. Cost: O(size p).
/// Errors: `refinement.from()` is not the knot vector of that direction (usage); a weight becomes zero (numerical).
template <int D>
[[nodiscard]] Expected<Spline<D>> refined(const Spline<D>& spline, int direction, const Refinement& refinement);

/// The same function with all of these knots inserted, per direction (`with_knots`; *The NURBS Book*, 5.3).
template <int D>
[[nodiscard]] Expected<Spline<D>> insert_knots(const Spline<D>& spline,
                                               const std::array<std::vector<double>, D>& inserted);

/// The same function with the degree of one direction raised `times` times (`elevated_knots`; *The NURBS Book*, 5.5).
/// Continuity is unchanged: every knot is repeated as many times more. Errors: degree above `max_degree`.
template <int D>
[[nodiscard]] Expected<Spline<D>> elevate_degree(const Spline<D>& spline, int direction, int times = 1);

/// The same function with every span that meets the box `region` in more than its boundary halved, in each direction
/// (`span_midpoints`); a side without length selects the spans it touches. As the net is a tensor product, the halved
/// spans run through the whole surface. Errors: a side that is not finite, decreases or misses the domain.
template <int D>
[[nodiscard]] Expected<Spline<D>> refine_region(const Spline<D>& spline, const std::array<Interval, D>& region);

/// The same function in Bézier pieces (`bezier_knots`): piece k of a direction, over the k-th span of positive length,
/// has the control points k (p + 1) … k (p + 1) + p.
template <int D>
[[nodiscard]] Expected<Spline<D>> bezier_pieces(const Spline<D>& spline);

/// The same function on its domain with clamped ends, which every program reads: the ends of the domain become knots of
/// multiplicity p + 1, and what lies outside is left out. Errors: those of `insert_knots`.
[[nodiscard]] Expected<Surface> with_clamped_ends(const Surface& surface);

}  // namespace knead
