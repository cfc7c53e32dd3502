#pragma once

#include <span>
#include <string>
#include <vector>

#include "shared_edge.hpp"

namespace knead::brep {

/// Another surface in place of one in the file: refined or coarser, over the same parameter domain.
struct Replacement {
  std::string id;  ///< "#123"
  Surface surface;
};

/// Another curve in space for an edge, through the same parameters as the one it replaces, in its
/// direction.
struct MovedEdge {
  std::string id;  ///< "#456"
  Curve curve;
};

/// Another place for a vertex.
struct MovedVertex {
  std::string id;  ///< "#78"
  Point place = Point::Zero();
};

/// Edges that have moved with their faces.
struct MovedEdges {
  std::vector<MovedEdge> edges;
  std::vector<MovedVertex> vertices;
};

/// The curve of an edge after its surfaces have moved: cubic, through the same parameters of the
/// record's curve.
///
/// At its ends it moves by the mean displacement of the surfaces, C(t) = C_before(t) + mean
/// (S_after − S_before)(foot of t), and keeps its distance from the vertices; farther inside than
/// an eighth it is the mean of the surfaces' points S_after(foot of t), with a smooth transition:
/// then it is no farther from either than half their distance. It is interpolated at the Greville
/// abscissae of a knot vector that is halved where four points inside a span deviate by more than
/// `tolerance`; corners get triple knots. \param before, after one for each of `edge.surfaces()`.
/// Errors: more than 4096 spans would be needed (numerical), and those of evaluation. Accuracy:
/// `tolerance`, at those points.
[[nodiscard]] Expected<Curve> moved_curve(const SharedEdge& edge,
                                          std::span<const Surface* const> before,
                                          std::span<const Surface* const> after, double tolerance);

/// The edges with these ids, and their vertices, as they are after some surfaces were replaced.
/// Edges and vertices that moved by less than rounding (1e-11 of the surfaces' size) are left out,
/// as are edges whose surfaces have parted by more than the file's uncertainty and 1e-5 of the
/// size of the model (the box of its vertices) or of the surfaces. The vertex that is all of a loop
/// goes along with the surface of its face. Results do not depend on the number of threads. Errors:
/// those of `SharedEdge::create` and `moved_curve`.
[[nodiscard]] Expected<MovedEdges> moved_edges(const Model& model,
                                               std::span<const Replacement> replacements,
                                               std::span<const std::string> ids);

}  // namespace knead::brep
