#include <Eigen/Dense>
#include <cmath>

#include "foot_search.hpp"

namespace knead::detail {
namespace {

std::size_t index(int k) { return static_cast<std::size_t>(k); }

double length(const Range& r) { return r.upper - r.lower; }

/// The patch a little way along side d, away from its end.
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
    if (n.norm() > 1e-9 * (j[1].squaredNorm() + j[2].squaredNorm())) return patch.orientation * n.normalized();
    j = nudged(patch, foot.at, d);
  }
  const Point n = j[1].cross(j[2]);
  return n.norm() > 0 ? Point(patch.orientation * n.normalized()) : Point(Point::Zero());
}

DistanceJet distance_jet(const Point& x, const Foot& foot, const Patch& patch, double sign, double size) {
  DistanceJet r;
  const Point way = x - foot.jet[0];
  const double away = way.norm();
  PatchJet j = foot.jet;
  const double tiny = 1e-9 * size;
  const auto vanishes = [&](std::size_t d) {
    return j[1 + d].norm() * std::max(length(patch.domain.side[d]), 1e-3) < tiny;
  };
  std::array<bool, 2> free = {!foot.pressed[0], !foot.pressed[1]};
  for (std::size_t d = 0; d < 2; ++d) {
    if (!free[d] || !vanishes(d)) continue;
    const bool pole = free[1 - d] && patch.pole(d, foot.at);
    if (!pole) {
      free[d] = false;  // an apex, or an end where the curvature is infinite
      continue;
    }
    // A pole: its curvatures are those a little way off, up to the square of that way.
    std::array<double, 2> off = foot.at;
    const Range& side = patch.domain.side[1 - d];
    off[1 - d] += (off[1 - d] - side.lower < side.upper - off[1 - d] ? 1e-4 : -1e-4) * length(side);
    j = patch.jet(off[0], off[1]);
    break;
  }
  Point surface = patch.orientation * j[1].cross(j[2]);
  const bool regular = surface.norm() > 1e-12 * j[1].norm() * j[2].norm() && surface.norm() > 0;
  if (regular) surface.normalize();
  const bool pressed = foot.pressed[0] || foot.pressed[1];
  if (regular && (away == 0 || (away < 1e-4 * size && !pressed && j[0] == foot.jet[0]))) {
    r.normal = surface;
    r.distance = way.dot(surface);
  } else {
    r.distance = sign * away;
    if (away == 0) return r;
    r.normal = way / r.distance;
  }
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - r.normal * r.normal.transpose();
  Eigen::Matrix<double, 3, 2> t;
  Eigen::Matrix2d bend = Eigen::Matrix2d::Zero();
  const Point n = free[0] && free[1] && regular ? (surface.dot(r.normal) < 0 ? Point(-surface) : surface) : r.normal;
  int count = 0;
  std::array<std::size_t, 2> which{};
  for (std::size_t d = 0; d < 2; ++d) {
    if (!free[d]) continue;
    which[index(count)] = d;
    t.col(count++) = j[1 + d];
  }
  if (count > 0) {
    for (int a = 0; a < count; ++a) {
      for (int b = 0; b < count; ++b) {
        const std::size_t da = which[index(a)], db = which[index(b)];
        bend(a, b) = n.dot(j[da != db ? 4 : da == 0 ? 3 : 5]);
      }
    }
    // −T G⁻¹ L (G − φ L)⁻¹ Tᵀ, G and L the fundamental forms over the free parameters.
    if (count == 1) {
      const Point e = t.col(0);
      const double g = e.squaredNorm(), m = g - r.distance * bend(0, 0);
      if (m > 1e-14 * g) r.hessian -= bend(0, 0) / (g * m) * e * e.transpose();
      if (r.distance != 0) r.hessian += (across - e * e.transpose() / g) / r.distance;
    } else {
      const Eigen::Matrix2d g = t.transpose() * t, m = g - r.distance * bend;
      if (m.determinant() > 1e-14 * g.determinant()) {
        const Eigen::Matrix2d middle = g.inverse() * bend * m.inverse();
        r.hessian = -(across * t) * middle * (across * t).transpose();
      }
    }
  } else if (r.distance != 0) {
    r.hessian = across / r.distance;
  }
  r.hessian = 0.5 * (r.hessian + r.hessian.transpose()).eval();
  return r;
}

}  // namespace knead::detail
