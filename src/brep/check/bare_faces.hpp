#pragma once

#include <optional>
#include <vector>

#include "checked_face.hpp"

namespace knead::brep {

/// A model in which every B-spline surface lies under a face.
struct FacedModel {
  Model model;
  /// Of each edge: the side of its surface that it is; none of the file's own.
  std::vector<std::optional<CheckedFace::Side>> sides;
};

/// Faces that cover their surfaces whole for those on which the model has none: a face is called as
/// its surface, "#55", its edges by their sides, "#55.u0", "#55.u1", "#55.v0", "#55.v1". A side
/// that is a point has no edge. None where every surface has a face. Cost: a copy of the model.
[[nodiscard]] std::optional<FacedModel> with_bare_faces(const Model& model);

}  // namespace knead::brep
