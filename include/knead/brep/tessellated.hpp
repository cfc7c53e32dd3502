#pragma once

#include <string>
#include <vector>

#include "knead/brep/face_mesh.hpp"

namespace knead::brep {

/// Triangles that a file holds instead of exact geometry.
struct TessellatedItem {
  std::string name;  ///< its label, or that of the nearest solid, shell or set that holds it
  std::string unit;  ///< of its coordinates, as in `LengthUnit::name`; "unknown" if it cannot be determined
  FaceMesh mesh;     ///< `id` is that of its record, `surface` empty
};

/// The tessellated items of a file. Only STEP files have them (docs/step.md). Coordinates are those of the item's
/// representation; the model's assembly says where that stands: its parts list the items among their faces.
struct TessellatedItems {
  std::vector<TessellatedItem> items;  ///< in the order of the file
  std::vector<SkippedFace> skipped;    ///< those that cannot be read, each with its reason
};

}  // namespace knead::brep
