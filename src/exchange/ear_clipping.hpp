#pragma once

#include "triangulate.hpp"

namespace knead {

/// Twice the signed area of the triangle a, b, c.
[[nodiscard]] inline double doubled_area(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Triangles of a polygon with holes and no further points (see `triangulate`); `points` are those of the loops in
/// order, of which the first `sizes[0]` are the outline.
[[nodiscard]] std::optional<std::vector<Triangle>> clip_ears(std::span<const Eigen::Vector2d> points,
                                                             std::span<const std::uint32_t> sizes);

}  // namespace knead
