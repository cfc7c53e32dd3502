#pragma once

#include <string>
#include <vector>

#include "hold/trim_hold.hpp"
#include "scene.hpp"

namespace knead {

/// Whether any edges of faces are held.
[[nodiscard]] bool holds_trims(const std::vector<KeptConstraint>& constraints);

/// Whether a tool of the scene touches only what is visible.
[[nodiscard]] bool touches_visible(const Scene& scene);

/// The order at which each edge of a region is held: by the last `TrimEdgeHold` with its id, or by
/// `TrimHolds`; −1 free.
[[nodiscard]] std::vector<int> trim_orders(const std::vector<KeptConstraint>& constraints,
                                           const VisibleRegion& region);

/// How far an edge may be from its original position: the larger of the file's uncertainty and 1e-7
/// of the surface's size.
[[nodiscard]] double trim_tolerance(const Surface& surface, const VisibleRegion& region);

/// Appends the constraints that hold the edges of the faces on a surface. Errors: those of
/// `hold_trims`.
Expected<TrimHold> hold_face_edges(const Surface& reference,
                                   const std::vector<KeptConstraint>& constraints,
                                   const VisibleRegion& region, ConstraintList& list);

/// A held edge of faces on which two shapes of a surface differ.
struct MovedTrim {
  std::string id;
  std::vector<std::string> neighbours;  ///< faces on the other side
  double distance = 0;                  ///< max |S_after − S_before| along it, file units
  /// The largest angle between the normals, radians; 0 where only its place is held.
  double turn = 0;
  /// Of that distance on `before`; of the turn where only that is too large.
  Point place = Point::Zero();
};

/// The held edges that do not stay where they are when a surface changes from one shape to another:
/// their distance is above `trim_tolerance`, or, where their tangent planes are held, the turn
/// above `accepted_angle`. Measured at every corner of a course and midway between corners. \param
/// orders of `trim_orders`. Requires: the same domain. Errors: those of evaluation.
[[nodiscard]] Expected<std::vector<MovedTrim>> moved_trims(const Surface& before,
                                                           const Surface& after,
                                                           const std::vector<int>& orders,
                                                           const VisibleRegion& region);

/// Whether an edge of faces was freed by name on a surface, or with all its edges, to open where
/// the surface moves.
[[nodiscard]] bool may_open(const std::vector<KeptConstraint>& constraints,
                            const std::string& edge);

/// The visible place where a tool acts on a surface, and its distance from the held edges.
struct TrimContact {
  std::array<double, 2> at = {0, 0};  ///< parameters
  double distance = 0;  ///< from the nearest held edge, on the surface as opened; infinite: none
};

/// Where a collision tool has penetrated a surface, or a proximity tool reaches it: deep inside and
/// far from held edges. None where it does neither on a grid of visible points, which is refined
/// around the best one.
[[nodiscard]] Expected<std::optional<TrimContact>> trim_contact(const SceneSurface& surface,
                                                                const Tool& tool);

/// A visible point, in fractions, at which the normals of two shapes of a surface point to opposite
/// sides although the shapes are more than 1e-9 of the size apart: sought at the centres of four by
/// four cells of every span. None if there is none. Errors: those of evaluation.
[[nodiscard]] Expected<std::optional<Eigen::Vector2d>> first_fold(const Surface& before,
                                                                  const Surface& after,
                                                                  const VisibleRegion& region);

/// The present state of the edges of the faces on a surface.
struct TrimReport {
  struct Edge {
    HeldEdge held;
    std::vector<std::string> neighbours;
    double deviation = 0;  ///< max |S − S_opened| along the edge
    bool follows = false;  ///< the edge moves by that with its faces
  };
  std::vector<Edge> edges;
  int free = 0, visible = 0;    ///< control points, as in `TrimHold`
  std::array<int, 2> net = {};  ///< control points by direction
  int samples = 0;              ///< points on all edges at which deviations were measured
  double largest = 0;           ///< largest deviation of any edge that does not follow, file units
};

/// Measures at every corner of every edge's course and midway between corners.
/// Requires: `surface.visible`. Errors: those of evaluation.
[[nodiscard]] Expected<TrimReport> trim_report(const SceneSurface& surface);

}  // namespace knead
