#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "brep/moved_edge.hpp"
#include "edges.hpp"

namespace knead::iges {

/// Another curve in space for a curve entity, which becomes a B-spline curve (126).
struct CurveReplacement {
  int number = 0;  ///< directory number
  Curve curve;     ///< in the coordinates of the model
  /// From the entity's own coordinates to the model's.
  Eigen::Affine3d move = Eigen::Affine3d::Identity();
};

/// Other coordinates for entries of vertex lists (502).
struct VertexReplacement {
  EdgeVertex vertex;
  Point place = Point::Zero();  ///< in the model
};

/// What edges that have moved change in a file.
struct MovedEntities {
  std::vector<CurveReplacement> curves;
  std::vector<VertexReplacement> vertices;
};

/// Whether an edge of the view can be written anew. Error (input): a curve along it belongs to
/// another edge, or makes a surface, that would move with it.
[[nodiscard]] Expected<void> can_move(const File& file, const EdgeSources& sources,
                                      const std::string& edge);

/// The entities that stand for moved edges and vertices of the view: each curve along an edge gets
/// the edge's new one, in its own direction.
[[nodiscard]] Expected<MovedEntities> moved_entities(const EdgeSources& sources,
                                                     const brep::MovedEdges& moved);

/// The parameters that make an entity this curve, with what others add to them.
[[nodiscard]] Expected<std::vector<std::string>> curve_values(const File& file,
                                                              const CurveReplacement& replacement,
                                                              const Parameters& parameters);

/// The parameters of the vertex lists with these coordinates, by directory number.
[[nodiscard]] Expected<std::map<int, std::vector<std::string>>> vertex_values(
    const File& file, std::span<const VertexReplacement> vertices);

/// Whether the curve entity is as it should be, to 1e-13, and the vertex list to the bit.
[[nodiscard]] bool reads_back(const File& after, const CurveReplacement& replacement);

}  // namespace knead::iges
