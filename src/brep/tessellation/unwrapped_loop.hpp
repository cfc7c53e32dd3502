#pragma once

#include <array>
#include <span>
#include <vector>

#include "parameter_region.hpp"

namespace knead {

using Polygon = std::vector<RegionPoint>;

/// A loop in the plane of unwrapped parameters: each point is the image nearest to the one before
/// it.
struct Unwrapped {
  Polygon points;
  std::array<int, 2> winding = {0, 0};  ///< turns made in each direction
};

/// Follows loop `number` over the seams. At a pole the direction around it is undetermined: along
/// the upper one a loop with its region on the left runs down, along the lower one up; points are
/// added there at whole steps.
[[nodiscard]] Unwrapped unwrap(const ParameterSpace& space, std::span<const LoopPoint> loop,
                               int number);

/// Adds points strictly between `from` and `to` at whole steps. By value: they may be the polygon's
/// own.
void add_between(Polygon& polygon, Eigen::Vector2d from, Eigen::Vector2d to);

}  // namespace knead
