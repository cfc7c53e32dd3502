#pragma once

#include <vector>

#include "knead/base/error.hpp"
#include "knead/brep/face_mesh.hpp"
#include "knead/brep/model.hpp"

namespace knead {

struct FaceMeshes {
  std::vector<FaceMesh> faces;
  std::vector<SkippedFace> skipped;
};

/// The faces of a model that do not lie on one of its `surfaces()`, as triangles: the context of
/// the surfaces that can be sculpted. Faces on planes, cylinders, cones, spheres, tori, surfaces of
/// revolution and of linear extrusion, and polygons (POLY_LOOP); edges on lines, conics, polylines
/// and B-spline curves (docs/context-faces.md).
///
/// Then the tessellated items of the model (tessellated.hpp), whatever the chord.
///
/// Coordinates are the file's, in the frame of the representation that the face belongs to, as
/// those of `surfaces()` are; the model's assembly says where that stands in the model.
///
/// \param chord how far a chord may be from its arc, as a share of the radius (for curves other
/// than circles: of half
///   their extent): arcs are divided into steps of at most 2 acos(1 − chord), faces have interior
///   points at such steps. A triangle is within 2 `chord` radii of its surface, and edges shared by
///   two faces have the same points in both, so that no gaps show. Between 1e-6 and 0.2.
/// Errors (usage): chord out of range. Faces that fail are listed in `skipped`, each with its
/// reason. Cost: linear in the file and in the triangles, quadratic in the number of points around
/// one face.
[[nodiscard]] Expected<FaceMeshes> context_faces(const brep::Model& model, double chord = 1e-3);

/// On which side of each of the file's `surfaces()` the material of its faces is not: 1 where their
/// normals are S_u × S_v, −1 where they are opposite (same_sense is false, or their shell is
/// turned); 0 where no face lies on it, or faces of both kinds do. Cost: a pass over the file.
[[nodiscard]] std::vector<int> face_senses(const brep::Model& model);

}  // namespace knead
