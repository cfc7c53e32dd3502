#pragma once

#include <Eigen/Geometry>
#include <set>
#include <string>
#include <vector>

#include "edges.hpp"
#include "file.hpp"
#include "knead/brep/model.hpp"

namespace knead::iges {

/// An IGES file as a model, and what of the file its edges stand for.
struct ReadModel {
  brep::Model model;
  EdgeSources sources;     ///< of its edges and vertices
  std::set<int> unplaced;  ///< subfigure instances that have no place in it
};

/// The B-spline surfaces (128, and 114 and 118 as such), the faces, 144, 143 and 510, with their
/// boundaries, 142, 141 and 508, and the subfigures of an IGES file. The entity D15 becomes #15, as
/// do faces, and edges on single curves; what has no entity of its own gets names above them.
/// Coordinates are the model's: transformation matrices are applied. Surfaces 108, 190 to 198, 120
/// and 122 and curves 100, 106, 110 and 126 are exact; what others are is told where they are
/// needed. A boundary that is only given in parameters is a polyline on the surface. Pieces of
/// boundaries along the same curve are one edge (`Edges`; those of several boundaries unless
/// subfigures are placed, whose coordinates are their own). Cost: linear in the file.
[[nodiscard]] ReadModel read_model(const File& file);

/// The matrix of the face that shows a B-spline surface, which the surface's own is applied before.
[[nodiscard]] Expected<Eigen::Affine3d> outer_transform(const File& file, int surface);

}  // namespace knead::iges
