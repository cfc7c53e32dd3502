#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "iges_edges.hpp"
#include "iges_file.hpp"
#include "knead/exchange/source.hpp"

namespace knead::iges {

/// The geometry of an IGES file in the words of STEP.
struct StepView {
  std::string text;                           ///< an exchange structure
  std::vector<UnreadableSurface> unreadable;  ///< B-spline surfaces that are none, ruled and offset surfaces
  EdgeSources sources;                        ///< of its edges and vertices
};

/// Writes the B-spline surfaces (128) and the faces of an IGES file, 144, 143 and 510, with their boundaries, 142, 141
/// and 508, as records of STEP, so that what reads those knows both. The entity D15 becomes #15, as do faces and edges
/// on single curves; what has no entity of its own gets names above them. Coordinates are the model's: transformation
/// matrices are applied. Surfaces 108, 190 to 198, 120 and 122 and curves 100, 106, 110 and 126 are exact; others
/// become records that STEP does not have, named by their type, which readers report where they need them. A boundary
/// that is only given in parameters is a polyline on the surface. Pieces of boundaries along the same curve are one
/// edge
/// (`Edges`; those of several boundaries unless subfigures are placed, whose coordinates are their own). A boundary
/// that cannot be read is one of those records. Cost: linear in the file.
[[nodiscard]] StepView step_view(const File& file);

/// The matrix of the face that shows a B-spline surface, which the surface's own is applied before.
[[nodiscard]] Expected<Eigen::Affine3d> outer_transform(const File& file, int surface);

}  // namespace knead::iges
