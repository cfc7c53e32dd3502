#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "knead/image/surface_snake.hpp"

namespace knead::testing {

/// A volume whose grey is ½ (1 − erf(d / (√2 σ))) where d is the distance from a shape, in space.
inline VolumeImage blurred(std::array<int, 3> size, const VolumeFrame& frame, double sigma,
                           const std::function<double(const Point&)>& distance) {
  VolumeImage volume{size, {}, frame};
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        const Point at = frame.origin + frame.directions * Point(i, j, k);
        volume.values.push_back((1 - std::erf(distance(at) / (std::numbers::sqrt2 * sigma))) / 2);
      }
    }
  }
  return volume;
}

inline VolumeImage blurred_ball(int size, const Point& centre, double radius, double sigma) {
  return blurred({size, size, size}, {}, sigma,
                 [&](const Point& p) { return (p - centre).norm() - radius; });
}

inline VolumeImage blurred_torus(std::array<int, 3> size, const Point& centre, double ring,
                                 double tube, double sigma) {
  return blurred(size, {}, sigma, [&](const Point& p) {
    const Point d = p - centre;
    return std::hypot(std::hypot(d[0], d[1]) - ring, d[2]) - tube;
  });
}

struct Radii {
  double mean = 0, least = 1e9, most = 0;
};

/// Of what `radius` says of points all over the surface.
template <class Radius>
Radii radii(const ClosedSurface& snake, const Radius& radius) {
  Radii r;
  const ClosedMesh mesh = closed_mesh(snake, 4);
  for (Eigen::Index k = 0; k < mesh.points.rows(); ++k) {
    const double d = radius(Point(mesh.points.row(k)));
    r.mean += d / static_cast<double>(mesh.points.rows());
    r.least = std::min(r.least, d);
    r.most = std::max(r.most, d);
  }
  return r;
}

inline Radii distances(const ClosedSurface& snake, const Point& centre) {
  return radii(snake, [&](const Point& p) { return (p - centre).norm(); });
}

}  // namespace knead::testing
