#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "knead/brep/model.hpp"

namespace knead::brep {

/// A surface of a model on which faces lie and that is no B-spline surface.
struct OtherSurface {
  std::string id;                  ///< "#12"
  std::string form;                ///< "PLANE", as its record calls it
  std::vector<std::string> faces;  ///< ids of the faces on it, in the order of the file
};

/// In the order of their first faces. Cost: a pass over the file.
[[nodiscard]] std::vector<OtherSurface> other_surfaces(const Model& model);

/// The ids of the surfaces, of every form, on which the faces at an edge lie, each once, in the
/// order of the faces.
[[nodiscard]] std::vector<std::string> surfaces_at_edge(const Model& model,
                                                        const std::string& edge);

/// The part of a plane, cylinder, cone, sphere, torus, surface of revolution or of linear extrusion
/// that the faces on it cover, as a B-spline surface with the same points and the same side of its
/// normal S_u × S_v (docs/step.md).
///
/// Exact but for rounding: control points are sums and products of what the file gives; to 1e-14 of
/// the distance of the part from the origin of its placement, and of its size. It ends in each
/// direction at an edge that runs along it, to the larger of the file's uncertainty and 1e-7 of the
/// size of its faces; elsewhere 2 % of the extent beyond the farthest point of the edges. It is a
/// whole turn where the faces leave open less than 2 % of one, from a seam or another edge along
/// which the angle is constant, where there is one. A swept spline is covered as a whole. \param id
/// of the surface, or of a face on it Errors (input): no such surface or face; a B-spline surface;
/// a form without an exact B-spline form, or that is not known; edges that cannot be read or are
/// off the surface. Cost: about that of the picture of its faces, and a pass over the file.
[[nodiscard]] Expected<Surface> exact_spline(const Model& model, const std::string& id);

/// The faces on the surface with this id, or on that of the face with this id. Errors (input): no
/// such surface or face; one on a B-spline surface, or on none.
[[nodiscard]] Expected<std::vector<const Face*>> faces_on_other(const Model& model,
                                                                const std::string& id);

/// `exact_spline` of each of the `other_surfaces`, in their order. Cost: that of each one's faces
/// and a pass over the file.
[[nodiscard]] std::vector<Expected<Surface>> exact_splines(const Model& model);

}  // namespace knead::brep
