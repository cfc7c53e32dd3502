#pragma once

#include "brep/tessellation/context_faces.hpp"
#include "knead/brep/model.hpp"
#include "knead/session/document.hpp"
#include "session/session_state.hpp"

namespace knead::studio {

/// Of loops and faces that are drawn (`trim_loops`, `context_faces`), so that both have the same
/// points along an edge: a circle of 10,000 pixels is drawn within one.
inline constexpr double drawn_chord = 1e-4;

/// The middle of these faces.
[[nodiscard]] Point middle_of(const brep::Model& model);
/// The middle of all control points, or without any of the faces: what positions of pictures are
/// measured from.
[[nodiscard]] Point middle_of(const Document& document);
/// A fresh document has its first surface or body somewhere. Far from there single precision would
/// show steps: from a hundred sizes of it on, pictures are measured from its middle, else from 0;
/// while there is none, from `otherwise`.
[[nodiscard]] Point origin_near(const SessionState& now, const Point& otherwise);

}  // namespace knead::studio
