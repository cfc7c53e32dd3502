#pragma once

#include <span>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead::detail {

/// The curve of a side of a surface, between two vertices.
struct NaturalEdge {
  Curve curve;
  int from = 0, to = 0;  ///< vertices
};

/// A surface on its natural bounds.
struct NaturalFace {
  struct Use {
    int edge = 0;
    bool forward = true;  ///< along its curve
  };
  std::vector<Use> loop;  ///< counterclockwise in the parameters; poles are left out
  bool flipped = false;   ///< against the other faces of its shell
  int shell = 0;
};

struct NaturalFaces {
  std::vector<Point> vertices;
  std::vector<NaturalEdge> edges;
  std::vector<NaturalFace> faces;  ///< one per surface
  std::vector<bool> closed = {};   ///< of each shell: every edge is used twice, in both directions
  [[nodiscard]] int shells() const { return static_cast<int>(closed.size()); }
};

/// Faces that cover whole surfaces, and share an edge where sides are the same curve: the same
/// degree, number of control points, knots but for scale and offset, control points to 1e-9 of the
/// largest surface's size, weights but for a factor, in either direction. An edge has two uses at
/// most; sides that meet become a shell whose faces are turned the same way where that is possible.
/// A side that is a point, a pole, has no edge. Cost: n log n, but for sides between the same two
/// vertices. Errors: those of evaluating a side.
[[nodiscard]] Expected<NaturalFaces> natural_faces(std::span<const Surface* const> surfaces);

}  // namespace knead::detail
