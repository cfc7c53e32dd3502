#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "knead/tool/shape.hpp"

namespace knead::studio {

/// The surface of a tool's shape as triangles in its own frame, unscaled, counterclockwise seen
/// from outside.
struct ToolPicture {
  std::vector<float> positions, normals;  ///< 3 per point; normals outwards, of length 1
  std::vector<std::uint32_t> indices;     ///< 3 per triangle
  bool open = false;                      ///< both of its sides are visible
  bool unbounded = false;                 ///< a square of side 1 stands for all of a plane
};

/// Round shapes are revolved profiles, the others grids of their parameters; a shape without a
/// picture of its own is drawn from its distances (`from_distances`). Points lie on the shape to
/// 1e-6 of its size.
[[nodiscard]] ToolPicture tool_picture(const Shape& shape);

/// Triangles from the signed distance alone, about `cells` along the longest side of the shape's
/// bounding box: surface nets, a point for each cell that the surface crosses, moved to the nearest
/// point of the surface. Edges are cut off by up to a cell. Empty for an unbounded shape. Cost:
/// cells³ nearest points.
[[nodiscard]] ToolPicture from_distances(const PlacedShape& shape, int cells = 32);

}  // namespace knead::studio
