#pragma once

#include <span>
#include <string>
#include <vector>

#include "knead/brep/model.hpp"

namespace knead {

/// A face at points along one of its edges. Of a face on a B-spline surface of the file the feet of
/// the points are known, so that it can be evaluated as it is now; the others are as the file has
/// them.
struct EdgeContactFace {
  std::string id;       ///< of the face, "#12"
  std::string surface;  ///< id of the B-spline surface on which it lies; empty: another surface
  std::vector<Eigen::Vector2d> feet;  ///< on the B-spline surface, fractions of its domain
  std::vector<Point> points;          ///< on another surface: the nearest points of it
};

/// An edge and the faces that meet there.
struct EdgeContact {
  std::string id;
  std::vector<Point> points;  ///< evenly along the parameter of its curve, ends included
  std::vector<EdgeContactFace>
      faces;          ///< by ascending id of their records; a face on both sides of a seam once
  bool seam = false;  ///< a face is on both of its sides
  /// The largest that the file states for a B-spline surface there; 0 if none.
  double uncertainty = 0;
  std::string unknown;  ///< why one of its faces cannot be followed there; empty: all are
};

/// The edges of the faces on a B-spline surface of a model, with everything that meets there, in
/// the order of `visible_region`; of several surfaces, each edge once. Feet are sought on the
/// surfaces as they are in the file, each from the one before, on closed surfaces a turn outside of
/// 0 … 1 where the edge goes on there. Errors (input): no such surface. Where a curve or a face
/// cannot be followed, `unknown` says why; such a face has no feet, and such an edge no points.
/// Cost: a pass over the file, and `samples` searches for the nearest point per face and edge.
[[nodiscard]] Expected<std::vector<EdgeContact>> edge_contacts(
    const brep::Model& model, std::span<const std::string> surfaces, int samples = 33);
[[nodiscard]] Expected<std::vector<EdgeContact>> edge_contacts(const brep::Model& model,
                                                               const std::string& surface,
                                                               int samples = 33);

}  // namespace knead
