#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// One edge of a face, in the parameters of the surface on which the face lies.
struct TrimEdge {
  std::string id;                       ///< the edge's id in its file, "#456"
  std::vector<std::string> neighbours;  ///< the adjacent faces, "#12"
  std::vector<std::string>
      supports;       ///< of each of them: the surface on which it lies, "#30 PLANE"
  bool seam = false;  ///< the same face is on both of its sides
  /// Points along the edge in fractions of the parameter domain: (0, 0) and (1, 1) are its corners.
  /// Each is the image nearest to the one before it; on closed surfaces they may lie outside 0 … 1.
  std::vector<Eigen::Vector2d> course;
  std::vector<Point> points;  ///< the same points in space
  /// Largest distance of the edge from the polygon of its course, in fractions; estimated at the
  /// midpoint of every chord.
  double deviation = 0;
};

/// The part of a surface that its faces show, and the edges that bound it.
struct VisibleRegion {
  bool in_shell = false;  ///< one of the faces belongs to a shell
  /// Faces, each as loops of fractions: a point is visible if an odd number of a face's loops
  /// enclose it. Empty: the whole surface. Faces over the seam of a closed surface appear once for
  /// each turn that overlaps 0 … 1.
  std::vector<std::vector<std::vector<Eigen::Vector2d>>> faces;
  std::vector<TrimEdge> edges;
  std::array<std::array<bool, 2>, 2> poles =
      {};                           ///< [direction][end]: that end of the domain is a single point
  std::array<bool, 2> closed = {};  ///< by direction
  double uncertainty = 0;           ///< as stated by the file, in its own unit; 0 if none

  /// Whether a point of the domain, in fractions, is visible. Cost: linear in the corners of the
  /// loops.
  [[nodiscard]] bool contains(const Eigen::Vector2d& at) const;
  /// The smallest rectangle of fractions within 0 … 1 that contains the visible part: lower and
  /// upper corner.
  [[nodiscard]] std::array<Eigen::Vector2d, 2> extent() const;
  /// Distance in space from the chords of the nearest edge; infinite where there are no edges.
  /// Edges with a false `which` do not count; if it is empty, all do.
  [[nodiscard]] double distance(const Point& p, const std::vector<bool>& which = {}) const;

  friend bool operator==(const VisibleRegion&, const VisibleRegion&) = default;
};

inline bool operator==(const TrimEdge& a, const TrimEdge& b) {
  return a.id == b.id && a.course == b.course && a.points == b.points;
}

/// A visible point of a surface.
struct VisiblePoint {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< fractions of the domain
  Point place = Point::Zero();
  double distance = 0;  ///< from the nearest edge; for `visible_near`: from the given place
};

/// The parameters at fractions of the domain, clamped to it.
[[nodiscard]] std::array<double, 2> parameters_of(const Surface& surface,
                                                  const Eigen::Vector2d& at);

/// The visible middle: the visible point of the surface that is farthest from all edges, in space.
///
/// The best of a grid of 41 × 41 over the visible extent, then of successively smaller grids around
/// it: within 1e-3 of the best where the distance has one peak per cell of the first grid. Without
/// edges: the middle of the domain. Errors: no part of the surface is visible at that resolution
/// (numerical); those of evaluation. Cost: 2500 points times the chords of all edges.
[[nodiscard]] Expected<VisiblePoint> visible_middle(const Surface& surface,
                                                    const VisibleRegion& region);

/// The visible point with the least `cost`, found on the same grids; its `distance` is that cost.
/// None where nothing is visible.
[[nodiscard]] Expected<std::optional<VisiblePoint>> visible_least(
    const Surface& surface, const VisibleRegion& region,
    const std::function<double(const Point&)>& cost);

/// The visible point nearest to a place, found on the same grids.
[[nodiscard]] Expected<VisiblePoint> visible_near(const Surface& surface,
                                                  const VisibleRegion& region, const Point& place);

}  // namespace knead
