#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// Triangles of one face.
struct FaceMesh {
  std::string id;  ///< "#123", of the ADVANCED_FACE, or of the tessellated item
  std::string
      surface;  ///< "#123", of the B-spline surface that it lies on; empty if it lies on another
  std::vector<Point> points;
  std::vector<Point>
      normals;  ///< unit, one per point, of the face: the surface's, reversed where same_sense is
                ///< false, and where a solid uses its shell turned, as round a hollow
  std::vector<std::array<std::uint32_t, 3>>
      triangles;             ///< counter-clockwise seen from the tip of the normal
  bool tessellated = false;  ///< the triangles are the file's own (tessellated.hpp)
};

/// A face that could not be triangulated, and why; the others are still usable.
struct SkippedFace {
  std::string id;
  Error reason;
};

}  // namespace knead

namespace knead::brep {

/// Triangles that a file holds instead of exact geometry.
struct TessellatedItem {
  std::string name;  ///< its label, or that of the nearest solid, shell or set that holds it
  std::string
      unit;  ///< of its coordinates, as in `LengthUnit::name`; "unknown" if it cannot be determined
  FaceMesh mesh;  ///< `id` is that of its record, `surface` empty
};

/// The tessellated items of a file. Only STEP files have them (docs/step.md). Coordinates are those
/// of the item's representation; the model's assembly says where that stands: its parts list the
/// items among their faces.
struct TessellatedItems {
  std::vector<TessellatedItem> items;  ///< in the order of the file
  std::vector<SkippedFace> skipped;    ///< those that cannot be read, each with its reason
};

}  // namespace knead::brep
