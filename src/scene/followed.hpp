#pragma once

#include <optional>

#include "hold/edge_coupling.hpp"
#include "hold/edge_course.hpp"
#include "scene/model/model.hpp"

namespace knead {

// Edges of faces that are free to move because all faces at them move together.

/// Whether the last thing said of this edge on a surface is that it follows.
[[nodiscard]] bool follows(const SceneSurface& surface, const std::string& edge);

/// The edges whose course is known and which follow all of their surfaces, these being selected.
[[nodiscard]] std::vector<FollowedInput> followed_inputs(const Scene& scene);

/// The one of these edges at which a seam joins two different surfaces, a smooth one if there are
/// several; none: null.
[[nodiscard]] const SharedEdge* followed_at(const std::vector<FollowedInput>& followed,
                                            const Seam& seam);

/// Edges with two surfaces or more, as points on all of them: the samples of their courses, and
/// four more for every span that they cross of any surface.
[[nodiscard]] std::vector<CoupledEdge> coupled_edges(const std::vector<FollowedInput>& followed,
                                                     std::span<const Surface* const> patches);

/// By how much the surfaces at an edge have parted: |(S_a − S_a,opened) − (S_b − S_b,opened)| at
/// its worst point. At a smooth edge also the angle between their tangent planes, from the normals
/// of the shapes as they are.
struct Parting {
  double distance = 0;   ///< file units
  double tolerance = 0;  ///< the larger of a tenth of the file's uncertainty and 1e-6 of the
                         ///< largest surface's size
  Point place = Point::Zero();
  double angle = 0;         ///< the largest, radians
  double angle_before = 0;  ///< the same as opened
  /// The largest angle as a multiple of what is asked there, `Scene::bend` and twice what it was:
  /// its part about the edge, by which derivatives across it differ, and the rest, which the slope
  /// of the distances makes.
  double kink_across = 0, kink_along = 0;
  Point kink_place = Point::Zero();  ///< of the largest angle
};
/// Measured at the samples of the course and at seven points in every span crossed. Requires: a
/// known course of surfaces of the scene. Errors: those of evaluation.
[[nodiscard]] Expected<Parting> parting(const Scene& scene, const SharedEdge& edge);

/// An end of an edge that moved although another edge there does not follow: the ids of that vertex
/// and that edge. None if there is none. Requires and errors as for `parting`.
struct StuckVertex {
  std::string vertex, edge;
  double distance = 0;  ///< by which the vertex moved, file units
};
[[nodiscard]] Expected<std::optional<StuckVertex>> stuck_vertex(const Scene& scene,
                                                                const SharedEdge& edge);

}  // namespace knead
