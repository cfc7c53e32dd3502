#pragma once

#include <memory>
#include <string_view>

#include "act.hpp"

namespace knead {

// What commands do that place control points, or change weights and knots: no model holds the
// surfaces there.

/// Puts a shape where its control points were placed: what is held is held in its new place, and
/// control points that did not move keep their bits in it. `rest` is left to the caller. Errors:
/// those of `with_control_points`.
template <int D>
[[nodiscard]] Expected<void> put(SceneShape<D>& s, std::shared_ptr<const Spline<D>> current);

/// A shape with the motion of another from one place to the next: where control points coincide
/// with those of `before` they take the bits of `after`. Itself where nothing moves.
template <int D>
[[nodiscard]] Expected<std::shared_ptr<const Spline<D>>> moved_along(
    const std::shared_ptr<const Spline<D>>& shape, const Spline<D>& before,
    const std::shared_ptr<const Spline<D>>& after);

/// The one door of such commands: whether what holds the surfaces that have changed since `before`
/// allows it. Frozen regions keep their control points to the bit, on another basis their points to
/// the tolerance of held edges; symmetries stay; no surface leaves the limit, but towards the
/// surface as opened; seams between selected surfaces that are coupled open no further than before,
/// and 1e-6 of the size; held edges of faces stay (`check_held_edges`). \param command what did it.
/// Errors: what forbids it, where, by how much, and what to do (input; of seams and edges
/// numerical).
[[nodiscard]] Expected<void> check_placed(Act& act, const Scene& before, std::string_view command);

}  // namespace knead
