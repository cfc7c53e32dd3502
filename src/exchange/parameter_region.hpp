#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// What the parameters of a surface are like.
struct ParameterSpace {
  std::array<double, 2> periods = {0, 0};  ///< length of one turn; 0 where the surface is not closed
  /// Values of a direction below and above which there is nothing, because all the surface is one point there.
  std::array<std::array<std::optional<double>, 2>, 2> poles = {};
};

/// A corner of a region.
struct RegionPoint {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  int loop = -1, index = -1;  ///< which given point it is; -1: added, at a pole or on a cut
};

/// A point of a loop in parameters, of which some may be undetermined: at a pole.
struct LoopPoint {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  std::array<bool, 2> free = {false, false};
};

/// A simply connected polygon and its holes, over the plane of unwrapped parameters.
struct RegionPart {
  std::vector<RegionPoint> outer;
  std::vector<std::vector<RegionPoint>> holes;
};

/// The part of a parameter space that loops bound, as polygons in the plane: the surface is cut open where it closes on
/// itself.
///
/// Each loop is followed over the seams, the region on its left. Loops that come back to where they began bound by
/// themselves; those that go round the surface bound in pairs, or with a pole, and are joined by a cut between two
/// points that see each other (d'Ocagne's bridge of holes, over the unwrapped plane). Where a closed surface (sphere,
/// torus) is bounded by one loop that runs clockwise, the region is all but what it encloses; elsewhere, and where two
/// loops go round, the directions of loops are not relied upon, since files have them wrong. No loops: the whole of a
/// closed surface.
/// Errors (input), without place: the loops bound nothing finite, or wind both ways, or no cut can be made.
/// Cost: O(n²) in the number of points of loops that go round, else O(n).
[[nodiscard]] Expected<std::vector<RegionPart>> parameter_region(const ParameterSpace& space,
                                                                 std::span<const std::vector<LoopPoint>> loops);

/// Twice the signed area; positive where it runs counter-clockwise.
[[nodiscard]] double doubled_area(std::span<const RegionPoint> polygon);
/// By the number of crossings of a ray.
[[nodiscard]] bool contains(std::span<const RegionPoint> polygon, const Eigen::Vector2d& p);

}  // namespace knead
