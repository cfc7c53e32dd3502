#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"
#include "spline/grid_lines.hpp"

namespace knead::brep {

/// Triangles between lines of a surface, counter-clockwise seen from where S_u × S_v points;
/// degenerate ones are left out. Normals are unit vectors; where S_u × S_v vanishes the mean over
/// the adjacent triangles.
struct GridMesh {
  Points points, normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Errors: those of evaluation.
[[nodiscard]] Expected<GridMesh> grid_mesh(const Surface& surface,
                                           const std::array<GridLines, 2>& lines);

/// (b − a) × (c − a), of a triangle's corners.
[[nodiscard]] Point facet(const Points& points, const std::array<std::uint32_t, 3>& triangle);

}  // namespace knead::brep
