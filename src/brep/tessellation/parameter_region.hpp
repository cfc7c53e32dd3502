#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// The structure of a surface's parameter space.
struct ParameterSpace {
  std::array<double, 2> periods = {0,
                                   0};  ///< length of one turn; 0 where the surface is not closed
  /// Lower and upper limits of a direction at which the whole surface is one point.
  std::array<std::array<std::optional<double>, 2>, 2> poles = {};
};

/// A corner of a region.
struct RegionPoint {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  int loop = -1, index = -1;  ///< which given point it is; -1: added, at a pole or on a cut
};

/// A point of a loop in parameters, some of which may be undetermined, at a pole.
struct LoopPoint {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  std::array<bool, 2> free = {false, false};
};

/// A simply connected polygon and its holes, in the plane of unwrapped parameters.
struct RegionPart {
  std::vector<RegionPoint> outer;
  std::vector<std::vector<RegionPoint>> holes;
};

/// The part of a parameter space bounded by loops, as polygons in the plane: the surface is cut
/// open where it closes on itself.
///
/// Each loop is followed over the seams, the region on its left. Loops that return to their start
/// are bounds by themselves; those that wind around the surface are bounds in pairs, or with a
/// pole, and are joined by a cut between two mutually visible points (d'Ocagne's bridge of holes,
/// in the unwrapped plane). Where a closed surface (sphere, torus) is bounded by one clockwise
/// loop, the region is everything it does not enclose; elsewhere, and where two loops wind around,
/// the directions of loops are not relied upon, since files get them wrong. No loops: the whole of
/// a closed surface. Errors (input), without place: the loops bound nothing finite, or wind in both
/// directions, or no cut can be made. Cost: O(n²) in the number of points of winding loops, else
/// O(n).
[[nodiscard]] Expected<std::vector<RegionPart>> parameter_region(
    const ParameterSpace& space, std::span<const std::vector<LoopPoint>> loops);

/// Twice the signed area; positive if counter-clockwise.
[[nodiscard]] double doubled_area(std::span<const RegionPoint> polygon);
/// By the number of crossings of a ray.
[[nodiscard]] bool contains(std::span<const RegionPoint> polygon, const Eigen::Vector2d& p);

}  // namespace knead
