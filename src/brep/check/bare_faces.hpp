#pragma once

#include <array>
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

/// In which directions all rows of control points are the same, to 1e-9 of the net's diagonal or
/// rounding: the surface is a curve, in both a point.
[[nodiscard]] std::array<bool, 2> collapsed_directions(const Surface& surface);

/// Whether it is neither that nor has all control points on a line.
[[nodiscard]] bool has_area(const Surface& surface);

/// Faces that cover their surfaces whole for those on which the model has none: a face is called as
/// its surface, "#55", its edges by their sides, "#55.u0", "#55.u1", "#55.v0", "#55.v1". A side
/// that is a point has no edge, a surface without area no face. None where every surface has a
/// face. Cost: a copy of the model.
[[nodiscard]] std::optional<FacedModel> with_bare_faces(const Model& model);

}  // namespace knead::brep
