#pragma once

#include <span>
#include <string>

#include "context_faces.hpp"

namespace knead {

/// A model as triangles: every face, cut along its edges, so that faces that share an edge meet in
/// the same points there. A closed shell gives a closed mesh (docs/context-faces.md).
///
/// Corners lie on the face or, at its edges, on the curve of the edge. Triangles are measured along
/// the normal at their centres and those of their sides, and divided where that is more than 0.65
/// of `tolerance`, at most six times: what lies between was within `tolerance` in every measured
/// file. Chords turn by no more than 0.5 radians. A B-spline surface without faces is taken whole,
/// and a tessellated item (tessellated.hpp) as it is. Every part stands where the assembly puts it
/// (model.hpp), as often as it is used; coordinates are the model's.
///
/// \param tolerance a length in the model's unit; 0: a two-thousandth of the diagonal of the
/// model's box Errors (usage): a tolerance below 0, or below 1e-7 of the diagonal, or not finite;
/// (input) a file without a face; those of its assembly; (numerical) an extent beyond double
/// precision. Faces that fail are listed in `skipped`, each with its reason. Cost: linear in the
/// file and in the triangles, quadratic in the number of points around one face.
[[nodiscard]] Expected<FaceMeshes> model_faces(const brep::Model& model, double tolerance = 0);

/// How many sides of triangles no other triangle continues: with the same two points, bit for bit,
/// in the opposite order. 0 for the mesh of a closed shell. Triangles with a repeated point count
/// as none. Cost: O(n log n).
[[nodiscard]] std::size_t open_sides(std::span<const FaceMesh> faces);

}  // namespace knead
