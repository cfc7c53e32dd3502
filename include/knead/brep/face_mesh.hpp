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
  std::string id;       ///< "#123", of the ADVANCED_FACE, or of the tessellated item
  std::string surface;  ///< "#123", of the B-spline surface that it lies on; empty if it lies on another
  std::vector<Point> points;
  std::vector<Point> normals;  ///< unit, one per point, of the face: the surface's, reversed where same_sense is false,
                               ///< and where a solid uses its shell turned, as round a hollow
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from the tip of the normal
  bool tessellated = false;                             ///< the triangles are the file's own (tessellated.hpp)
};

/// A face that could not be triangulated, and why; the others are still usable.
struct SkippedFace {
  std::string id;
  Error reason;
};

}  // namespace knead
