#pragma once

#include <string>

#include "exchange/faces/face_plan.hpp"

namespace knead::iges {

/// A new IGES file (5.3, fixed ASCII form) of the faces of a model, its surfaces without faces and
/// its curves.
///
/// Faces (510) with loops (508) of edges (504) and vertices (502) that they share as in the model,
/// in shells (514); closed ones are solids (186) with the shells of their hollows. Surfaces are
/// entities 128 and 190 to 198; swept surfaces, and tori that cross themselves, are B-splines exact
/// but for rounding. Edges are lines (110), arcs (100) and B-spline curves (126). There are no
/// curves in parameters. Parts that do not stand once at their own origin are subfigures (308), and
/// each of their places an instance (408). Errors (input): a unit that IGES does not have; a
/// surface that it cannot hold.
[[nodiscard]] Expected<std::string> model_text(const detail::FacePlan& plan,
                                               const SaveOptions& options);

}  // namespace knead::iges
