#pragma once

#include "fit_nets.hpp"

namespace knead::morph {

/// A curve along which two surfaces, or two sides of one, stay together: an edge, a knot line at
/// which a surface is only continuous, or the line at which a closed surface meets itself.
struct Joint {
  /// One side at a point of the curve.
  struct Foot {
    std::array<double, 2> at = {};                     ///< parameters
    Eigen::Vector2d across = Eigen::Vector2d::Zero();  ///< in parameters: a unit vector in space
  };
  std::string edge;                  ///< its name; empty: a line of the surface
  std::array<int, 2> surfaces = {};  ///< the second is −1 where the first keeps its place
  std::array<Side, 2> sides = {Side::right, Side::right};  ///< of which limits are taken at knots
  std::vector<std::array<Foot, 2>> points;
  /// Of each point, by how much the displacement of the first side is to be larger than that of the
  /// second; empty: they are to be equal.
  std::vector<Point> apart = {};
  bool smooth = false;   ///< tangent planes are common, where `across` is not zero
  bool position = true;  ///< whether positions are asked: not where the basis keeps them
  double length = 0;     ///< file units
  double position_share = 1, slope_share = 1;  ///< of its weights, of what is usual
};

/// The joints of edges of two surfaces or more, at the samples of their courses and at least p + 1
/// points, and (p + 1)²/4, in every span crossed of either surface.
[[nodiscard]] std::vector<Joint> joints_of_edges(std::span<const FitEdge> edges,
                                                 const FitNets& nets);

/// Lets sides of joints that are parted by more than `closed` move apart as a displacement of space
/// says. Errors: those of evaluation and of the displacement.
[[nodiscard]] Expected<void> part_joints(
    std::span<Joint> joints, const FitNets& nets, double closed,
    const std::function<Expected<Point>(const Point&)>& displacement);

/// The knot lines of surfaces that are not fixed at which the basis is continuous at most and
/// tangent planes of the surface are common, within `smooth_angle`; and so where closed surfaces
/// meet themselves. Errors: those of evaluation.
[[nodiscard]] Expected<std::vector<Joint>> joints_of_lines(const FitNets& nets);

/// The largest angle, degrees, between the tangent planes on both sides at the points of smooth
/// joints, less what it is in the surfaces before; and the point at which it is.
struct JointAngle {
  double degrees = 0;
  std::size_t point = 0;
};
[[nodiscard]] Expected<JointAngle> largest_angle(const Joint& joint,
                                                 std::span<const Surface> before,
                                                 std::span<const Surface> after);

}  // namespace knead::morph
