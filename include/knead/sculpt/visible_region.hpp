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

/// One edge of a face, in parameters of the surface that the face lies on.
struct TrimEdge {
  std::string id;                       ///< of the edge in its file, "#456"
  std::vector<std::string> neighbours;  ///< the other faces that meet there, "#12"
  bool seam = false;                    ///< the same face is on both of its sides
  /// Points along the edge in fractions of the parameter domain: (0, 0) and (1, 1) are its corners. Each is next to the
  /// one before it; on closed surfaces they may reach beyond 0 … 1.
  std::vector<Eigen::Vector2d> course;
  std::vector<Point> points;  ///< the same in space, one for each
  /// The edge is nowhere further than this from the polygon of its course, in fractions; estimated at the middle of
  /// every chord.
  double deviation = 0;
};

/// What the faces on one surface show of it, and the edges that bound them.
struct VisibleRegion {
  bool in_shell = false;  ///< one of the faces belongs to a shell
  /// Faces, each as loops of fractions: visible is what an odd number of a face's loops encloses. Empty: the whole
  /// surface. Faces over the seam of a closed surface come once for each turn that shows some of them in 0 … 1.
  std::vector<std::vector<std::vector<Eigen::Vector2d>>> faces;
  std::vector<TrimEdge> edges;
  std::array<std::array<bool, 2>, 2> poles = {};  ///< [direction][end]: that end of the domain is one point
  std::array<bool, 2> closed = {};                ///< by direction
  double uncertainty = 0;                         ///< that the file states, in its own unit; 0 if none

  /// Whether a point of the domain, in fractions, is visible. Cost: linear in the corners of the loops.
  [[nodiscard]] bool contains(const Eigen::Vector2d& at) const;
  /// The smallest rectangle of fractions within 0 … 1 that holds what is visible: lower and upper corner.
  [[nodiscard]] std::array<Eigen::Vector2d, 2> extent() const;
  /// Distance in space from the chords of the nearest edge; infinite where there are no edges. Edges for which `which`
  /// is false do not count; empty: all do.
  [[nodiscard]] double distance(const Point& p, const std::vector<bool>& which = {}) const;

  friend bool operator==(const VisibleRegion&, const VisibleRegion&) = default;
};

inline bool operator==(const TrimEdge& a, const TrimEdge& b) {
  return a.id == b.id && a.course == b.course && a.points == b.points;
}

/// A point of a surface that can be seen.
struct VisiblePoint {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< fractions of the domain
  Point place = Point::Zero();
  double distance = 0;  ///< from the nearest edge; from `visible_near`: from the place asked for
};

/// The parameters of fractions of the domain, clamped to it.
[[nodiscard]] std::array<double, 2> parameters_of(const Surface& surface, const Eigen::Vector2d& at);

/// The visible middle: the visible point of the surface that is farthest from all edges, in space.
///
/// The best of a grid of 41 × 41 over the visible extent, then of ever smaller grids round it: within 1e-3 of the best
/// where the distance has one peak per cell of the first grid. Without edges: the middle of the domain.
/// Errors: nothing of the surface is visible at that resolution (numerical); those of evaluation.
/// Cost: 2500 points times the chords of all edges.
[[nodiscard]] Expected<VisiblePoint> visible_middle(const Surface& surface, const VisibleRegion& region);

/// The visible point with the least `cost` of its place, by the same grids; its `distance` is that cost. None where
/// nothing is visible.
[[nodiscard]] Expected<std::optional<VisiblePoint>> visible_least(const Surface& surface, const VisibleRegion& region,
                                                                  const std::function<double(const Point&)>& cost);

/// The visible point nearest to a place, by the same grids.
[[nodiscard]] Expected<VisiblePoint> visible_near(const Surface& surface, const VisibleRegion& region,
                                                  const Point& place);

}  // namespace knead
