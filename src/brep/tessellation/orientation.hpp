#pragma once

#include <Eigen/Core>

namespace knead {

/// Twice the signed area of the triangle a, b, c, to rounding.
[[nodiscard]] inline double doubled_area(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                         const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Exactly on which side of the line from a to b the point c is: 1 on the left, -1 on the right, 0
/// on the line.
///
/// The area to rounding decides where it is larger than its error (3 + 16u)u(|l| + |r|) of the two
/// products l and r; else the six products of coordinates are summed without rounding (Shewchuk,
/// "Adaptive precision floating-point arithmetic and fast robust geometric predicates", 1997).
/// Exact as long as no product of two coordinates overflows or, unless it is 0, lies below 1e-290.
[[nodiscard]] int orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                              const Eigen::Vector2d& c);

}  // namespace knead
