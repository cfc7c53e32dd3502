#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "knead/brep/context_faces.hpp"
#include "knead/brep/model.hpp"
#include "knead/brep/trim_loops.hpp"
#include "knead/brep/visible_region.hpp"
#include "knead/scene/display.hpp"
#include "knead/session/document.hpp"
#include "knead/session/session.hpp"

namespace knead::studio {

/// Of loops and faces that are drawn (`trim_loops`, `context_faces`), so that both have the same points along an edge:
/// a circle of 10,000 pixels is drawn within one.
inline constexpr double drawn_chord = 1e-4;

/// The faces around the surfaces as triangles; points relative to the requested origin.
struct ContextPicture {
  /// One of them, with the surface it lies on; that is empty where no record describes it. The form of tessellated
  /// items is TRIANGLES.
  struct Face {
    std::string id, surface, form;
    std::size_t triangles = 0;
  };
  std::vector<float> positions, normals;  ///< 3 per point
  std::vector<std::uint32_t> indices;     ///< 3 per triangle, face after face
  std::vector<Face> faces;
  std::vector<SkippedFace> skipped;  ///< faces that could not be triangulated
};

[[nodiscard]] ContextPicture context_picture(const brep::Model& model, const Point& origin);

/// The middle of these faces.
[[nodiscard]] Point middle_of(const brep::Model& model);
/// The middle of all control points, or without any of the faces: what positions of pictures are measured from.
[[nodiscard]] Point middle_of(const Document& document);
/// A fresh document has its first surface or body somewhere. Far from there single precision would show steps: from
/// a hundred sizes of it on, pictures are measured from its middle, else from 0; while there is none, from `otherwise`.
[[nodiscard]] Point origin_near(const SessionState& now, const Point& otherwise);

/// {"buffers": …, "faces": [{"id": "#11", "surface": "#10", "form": "PLANE", "triangles": 2}, …], "skipped": [{"id":
/// "#12", "reason": "…"}, …],
/// "left_out": ["2 points (#7, #9): a point has no surface", …]}: what of the source is not drawn, skipped faces
/// included.
[[nodiscard]] std::string context_json(const ContextPicture& context, const Source& source);

/// {"faces": [[[s, t, s, t, …], …], …]}: the loops of each face, in fractions of the domain; null for a whole surface.
[[nodiscard]] std::string trim_json(const SurfaceTrim& trim);

/// [{"id": "#456", "course": [s, t, s, t, …]}, …]: the edges of the faces on a surface, in fractions of the domain.
[[nodiscard]] std::string face_edges_json(const VisibleRegion& region);

}  // namespace knead::studio
