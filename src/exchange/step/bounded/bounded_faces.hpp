#pragma once

#include <map>
#include <string>
#include <vector>

#include "boundary_pieces.hpp"
#include "exchange/step/faces.hpp"

namespace knead::step {

/// What of the file the edges of bounded surfaces stand for, by id: an edge that is the limit of
/// parameters, or given in parameters alone, has no source, and moves with its surface by itself.
struct BoundaryEdge {
  std::vector<BoundarySource> sources;
  std::vector<BoundarySource>
      in_parameters;   ///< segments that refer to a PCURVE alone, as they have no curve in space
  bool fixed = false;  ///< it cannot move
};
using BoundarySources = std::map<std::string, BoundaryEdge>;

/// Gives the faces that are surfaces their bounds: of a RECTANGULAR_TRIMMED_SURFACE the sides of
/// its parameters, of a CURVE_BOUNDED_SURFACE its boundaries, before which its implicit one comes.
/// Surfaces share no edges in a file: pieces of those in one representation that run along each
/// other are one edge. `faces` are the records of the model's. What cannot be read is a bound with
/// a fault.
[[nodiscard]] BoundarySources bound_surfaces(const Reader& reader,
                                             const std::vector<FaceRecord>& faces,
                                             brep::Model& model);

}  // namespace knead::step
