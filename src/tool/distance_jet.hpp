#pragma once

#include "spline/foot_search.hpp"

namespace knead::detail {

/// Signed distance with its derivatives at x, from the nearest point and the sign of x's side.
struct DistanceJet {
  double distance = 0;
  Point normal = Point::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};
/// The unit normal S_u × S_v at a foot (at a pole, of a point very near it); zero where undefined.
[[nodiscard]] Point foot_normal(const Foot& foot, const Patch& patch);
[[nodiscard]] DistanceJet distance_jet(const Point& x, const Foot& foot, const Patch& patch,
                                       double sign, double size);

}  // namespace knead::detail
