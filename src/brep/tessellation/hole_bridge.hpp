#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace knead {

/// Corners of a closed polygon, by the indices of their points. Those at a bridge occur twice.
using Ring = std::vector<std::uint32_t>;

/// Joins holes to the outline of a polygon, each by a bridge that is walked once each way: what
/// remains is one ring without crossings, on whose left the polygon is.
///
/// \param outline counter-clockwise
/// \param holes clockwise, inside the outline and outside of each other
/// \returns the ring: all corners of all rings, and two more for each hole
///
/// Points are ordered by x, then by y: by a vertical line that is tilted a little and sweeps from
/// left to right. Holes are joined in the order of their first points. Let p be the first point of
/// a hole, b the side of the ring that the line through p meets next below p, a the one above, and
/// h the last corner before p that is neither before the beginnings of a and b nor outside the
/// strip between them. To the right of h and left of p, the strip has no corner of the ring, nor,
/// as all other holes begin after p, of anything else; and no side can cross it without crossing a
/// or b. So the segment from h to p lies inside the polygon and meets nothing: it is the bridge (as
/// the diagonals of a partition into monotone polygons; de Berg et al., Computational Geometry,
/// § 3.2). Where several corners are at the place of h, the bridge leaves that one in whose inner
/// angle it begins: inner angles at one place do not overlap, so there is one. All of this is
/// decided by the order of coordinates and by `orientation`, without rounding.
///
/// Holes that touch the ring or each other are joined where they do; what crosses is joined
/// somewhere. Cost: O(n) for each hole, n points.
[[nodiscard]] Ring bridged(std::span<const Eigen::Vector2d> points, Ring outline,
                           std::vector<Ring> holes);

}  // namespace knead
