#include "distance_jet.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace knead::detail {
namespace {

double length(const Range& r) { return r.upper - r.lower; }

/// The patch slightly further along direction d, away from its end.
PatchJet nudged(const Patch& patch, std::array<double, 2> at, std::size_t d) {
  const Range& side = patch.domain.side[d];
  at[d] += (at[d] - side.lower < side.upper - at[d] ? 1e-4 : -1e-4) * length(side);
  return patch.jet(at[0], at[1]);
}

}  // namespace

Point foot_normal(const Foot& foot, const Patch& patch) {
  PatchJet j = foot.jet;
  for (std::size_t d = 0; d < 2; ++d) {
    const Point n = j[1].cross(j[2]);
    if (n.norm() > 1e-9 * (j[1].squaredNorm() + j[2].squaredNorm()))
      return patch.orientation * n.normalized();
    j = nudged(patch, foot.at, d);
  }
  const Point n = j[1].cross(j[2]);
  return n.norm() > 0 ? Point(patch.orientation * n.normalized()) : Point(Point::Zero());
}

namespace {

/// The surface near a foot: its derivatives, taken slightly off a pole, and the parameters along
/// which it continues.
struct Vicinity {
  PatchJet jet;
  std::array<bool, 2> free;
};

Vicinity vicinity(const Foot& foot, const Patch& patch, double size) {
  Vicinity v{foot.jet, {!foot.pressed[0], !foot.pressed[1]}};
  for (std::size_t d = 0; d < 2; ++d) {
    const bool vanishes =
        v.jet[1 + d].norm() * std::max(length(patch.domain.side[d]), 1e-3) < 1e-9 * size;
    if (!v.free[d] || !vanishes) continue;
    const bool pole = v.free[1 - d] && patch.pole(d, foot.at);
    if (!pole) {
      v.free[d] = false;  // an apex, or an end where the curvature is infinite
      continue;
    }
    // A pole: its curvatures are those slightly off it, up to the square of that distance.
    v.jet = nudged(patch, foot.at, 1 - d);
    break;
  }
  return v;
}

/// The Hessian where the surface continues along both parameters, n its normal on the side of
/// r.normal: −T G⁻¹ L (G − φ L)⁻¹ Tᵀ, G and L the fundamental forms.
Eigen::Matrix3d hessian_of_surface(const DistanceJet& r, const PatchJet& j, const Point& n,
                                   const Eigen::Matrix3d& across) {
  Eigen::Matrix<double, 3, 2> t;
  t.col(0) = j[1];
  t.col(1) = j[2];
  Eigen::Matrix2d bend = Eigen::Matrix2d::Zero();
  bend(0, 0) = n.dot(j[3]);
  bend(0, 1) = bend(1, 0) = n.dot(j[4]);
  bend(1, 1) = n.dot(j[5]);
  const Eigen::Matrix2d g = t.transpose() * t, m = g - r.distance * bend;
  if (!(m.determinant() > 1e-14 * g.determinant())) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix2d middle = g.inverse() * bend * m.inverse();
  return -(across * t) * middle * (across * t).transpose();
}

/// The same along an edge with derivatives e and ee, around which the distance is rotationally
/// symmetric.
Eigen::Matrix3d hessian_of_edge(const DistanceJet& r, const Point& e, const Point& ee,
                                const Eigen::Matrix3d& across) {
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  const double bend = r.normal.dot(ee), g = e.squaredNorm(), m = g - r.distance * bend;
  if (m > 1e-14 * g) hessian -= bend / (g * m) * e * e.transpose();
  if (r.distance != 0) hessian += (across - e * e.transpose() / g) / r.distance;
  return hessian;
}

}  // namespace

DistanceJet distance_jet(const Point& x, const Foot& foot, const Patch& patch, double sign,
                         double size) {
  DistanceJet r;
  const Point offset = x - foot.jet[0];
  const double away = offset.norm();
  const auto [j, free] = vicinity(foot, patch, size);
  Point surface = patch.orientation * j[1].cross(j[2]);
  const bool regular = surface.norm() > 1e-12 * j[1].norm() * j[2].norm() && surface.norm() > 0;
  if (regular) surface.normalize();
  const bool pressed = foot.pressed[0] || foot.pressed[1];
  if (regular && (away == 0 || (away < 1e-4 * size && !pressed && j[0] == foot.jet[0]))) {
    r.normal = surface;
    r.distance = offset.dot(surface);
  } else {
    r.distance = sign * away;
    if (away == 0) return r;
    r.normal = offset / r.distance;
  }
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - r.normal * r.normal.transpose();
  if (free[0] && free[1]) {
    const Point n = regular ? (surface.dot(r.normal) < 0 ? Point(-surface) : surface) : r.normal;
    r.hessian = hessian_of_surface(r, j, n, across);
  } else if (free[0] || free[1]) {
    r.hessian = hessian_of_edge(r, j[free[0] ? 1 : 2], j[free[0] ? 3 : 5], across);
  } else if (r.distance != 0) {
    r.hessian = across / r.distance;
  }
  r.hessian = 0.5 * (r.hessian + r.hessian.transpose()).eval();
  return r;
}

}  // namespace knead::detail
