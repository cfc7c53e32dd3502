#pragma once

#include <Eigen/Dense>
#include <array>

#include "knead/spline/basis.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// S and its derivatives to order 2 (00, 10, 01, 20, 11, 02) at one point, without traversing the
/// whole net.
struct SurfaceJet {
  std::array<Point, 6> d;
};

/// The first `Count` of these derivatives of (w S, w).
template <std::size_t Count>
std::array<Eigen::Vector4d, Count> homogeneous_jet(const Surface& surface, double u, double v) {
  constexpr int order = Count == 1 ? 0 : 2;
  const KnotVector& ku = surface.knots(0);
  const KnotVector& kv = surface.knots(1);
  const int p = ku.degree(), q = kv.degree(), n = kv.count(), su = ku.find_span(u),
            sv = kv.find_span(v);
  std::array<double, static_cast<std::size_t>(order + 1) * (max_degree + 1)> nu, nv;
  basis_derivatives(ku, su, u, order, nu.data());
  basis_derivatives(kv, sv, v, order, nv.data());
  static constexpr std::array<std::array<int, 2>, 6> orders = {
      {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
  std::array<Eigen::Vector4d, Count> h;
  h.fill(Eigen::Vector4d::Zero());
  for (int r = 0; r <= p; ++r) {
    for (int c = 0; c <= q; ++c) {
      const int index = (su - p + r) * n + sv - q + c;
      const double weight =
          surface.rational() ? surface.weights()[static_cast<std::size_t>(index)] : 1;
      Eigen::Vector4d point;
      point << weight * surface.control_points().row(index).transpose(), weight;
      for (std::size_t k = 0; k < Count; ++k) {
        h[k] += nu[static_cast<std::size_t>(orders[k][0] * (p + 1) + r)] *
                nv[static_cast<std::size_t>(orders[k][1] * (q + 1) + c)] * point;
      }
    }
  }
  return h;
}

/// S, where the denominator is known to be positive.
inline Point surface_point(const Surface& surface, double u, double v) {
  const Eigen::Vector4d h = homogeneous_jet<1>(surface, u, v)[0];
  return surface.rational() ? Point(h.head<3>() / h[3]) : Point(h.head<3>());
}

/// Likewise.
inline SurfaceJet surface_jet(const Surface& surface, double u, double v) {
  const auto h = homogeneous_jet<6>(surface, u, v);
  SurfaceJet jet;
  auto& d = jet.d;
  for (std::size_t k = 0; k < 6; ++k) d[k] = h[k].head<3>();
  if (!surface.rational()) return jet;
  const double w = h[0][3], wu = h[1][3],
               wv = h[2][3];  // the quotient rule: derivatives of w S = A
  d[0] /= w;
  d[1] = (d[1] - wu * d[0]) / w;
  d[2] = (d[2] - wv * d[0]) / w;
  d[3] = (d[3] - 2 * wu * d[1] - h[3][3] * d[0]) / w;
  d[4] = (d[4] - wu * d[2] - wv * d[1] - h[4][3] * d[0]) / w;
  d[5] = (d[5] - 2 * wv * d[2] - h[5][3] * d[0]) / w;
  return jet;
}

}  // namespace knead
