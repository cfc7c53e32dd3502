#pragma once

#include <vector>

#include "scene.hpp"

namespace knead {

/// Whether a surface is asked to hold the edges of its faces but has none, closed as it is: then
/// its place is held. Requires: `visible` is known where holds ask for it.
[[nodiscard]] bool holds_its_place(const SceneSurface& surface);

/// Whether anything of a surface is held: rows, points, regions, lines, edges or its place.
[[nodiscard]] bool holds_anything(const SceneSurface& surface);

/// A spring for each selected surface that `holds_its_place`, on the control points of all of them,
/// stacked: it holds the centre of the surface where it is on `points`.
///
/// Constant displacements are all that stretch and bend of displacements leave unresisted. With the
/// shares w_i = ∫R_i dA / ∫dA of the area of the reference shape a spring on Σ w_i X_i resists
/// them, and its reaction is spread evenly over the surface, so that what tools press dents. It is
/// `anchor_stiffness` times as stiff as the stiffest tool: a tool moves the centre by at most about
/// that part of its depth a step. `model`: that of the selected surfaces. Errors: a rational
/// denominator that is not positive (numerical). Cost: an integration over the surface.
[[nodiscard]] Expected<std::vector<PointForce>> anchors(const Scene& scene,
                                                        const ActiveSurface& model,
                                                        const Points& points);

/// The same of shells, whose stretch and bend leave rotations unresisted as well; tools turn them
/// where they press beside the centre.
[[nodiscard]] Expected<std::vector<PointForce>> shell_anchors(const Scene& scene,
                                                              const Points& points);

inline constexpr double anchor_stiffness = 1e4;

}  // namespace knead
