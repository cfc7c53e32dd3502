#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace knead {

using Triangle = std::array<std::uint32_t, 3>;

/// The constrained Delaunay triangulation of a polygon with holes and points inside it.
///
/// \param loops the polygon counter-clockwise, then its holes clockwise
/// \param inside further points, in the polygon but not on its sides
/// \returns counter-clockwise triangles; indices count the points of `loops` in order, then
/// `inside`. None if sides
///   cross so that no ear is left.
///
/// Holes are bridged to the outline (`bridged`) and ears cut off (Meisters 1975), which is decided
/// without rounding and needs no point outside and no tolerance; then sides that are not bounds are
/// flipped until every circumcircle is empty (Lawson 1977), and further points are inserted one by
/// one, each with its flips. Cost: O(n²) in the points of the loops at worst; about O(k) for k
/// points inside given row by row.
[[nodiscard]] std::optional<std::vector<Triangle>> triangulate(
    std::span<const std::vector<Eigen::Vector2d>> loops, std::span<const Eigen::Vector2d> inside);

}  // namespace knead
