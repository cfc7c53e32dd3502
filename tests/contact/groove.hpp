#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "knead/spline/evaluate.hpp"

namespace knead::testing {

/// What a stroke over a flat sheet at z = 0 has left, in lengths of the sheet: the sheet is sampled
/// on a grid of its parameters and seen from above.
struct Groove {
  double shallowest = 0,
         deepest = 0;  ///< of the bottom along the path, apart from one radius at both ends
  double width = 0;    ///< widest at half depth, across the path
  double beyond = 0;   ///< largest displacement further than 2.5 radii from the path
  double rim = 0;      ///< highest point of the sheet
  double ripple = 0;   ///< across the groove: largest rise on the way down to the bottom
  double lowest = 0;   ///< deepest point of the sheet
};

/// The points of surfaces on equal grids of their parameters, one surface after the other.
inline Points sampled(const std::vector<const Surface*>& surfaces) {
  const int samples = surfaces.size() == 1 ? 801 : 501;
  const auto each = static_cast<Eigen::Index>(samples) * samples;
  Points points(each * static_cast<Eigen::Index>(surfaces.size()), 3);
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    Parameters<2> grid(each, 2);
    const Interval u = surfaces[k]->knots(0).domain(), v = surfaces[k]->knots(1).domain();
    for (int i = 0; i < samples; ++i) {
      for (int j = 0; j < samples; ++j)
        grid.row(static_cast<Eigen::Index>(i) * samples + j)
            << u.lower + u.length() * i / (samples - 1),
            v.lower + v.length() * j / (samples - 1);
    }
    points.middleRows(each * static_cast<Eigen::Index>(k), each) =
        evaluate<2>(*surfaces[k], grid, 0)->at({0, 0});
  }
  return points;
}

/// \param displaced the sheet, of one surface or of several that lie in the plane, \param flat as
/// it was. Depths are positive.
inline Groove groove_of(const std::vector<const Surface*>& displaced,
                        const std::vector<const Surface*>& flat, const Point& from, const Point& to,
                        double radius, double depth) {
  const Points after = sampled(displaced), before = sampled(flat);
  Groove g;
  const Point along = (to - from).normalized(), across(-along.y(), along.x(), 0);
  const double length = (to - from).norm();
  const double cell = (before.row(1) - before.row(0)).norm();
  // Depths over (along, across), in cells of the samples' size.
  const int n = static_cast<int>(length / cell), m = static_cast<int>(2.5 * radius / (2 * cell));
  std::vector<double> lowest(static_cast<std::size_t>(n), 1e300);
  std::vector<double> left(lowest.size(), 0), right(lowest.size(), 0);
  std::vector<double> sum(static_cast<std::size_t>(2 * m + 1), 0), count(sum.size(), 0);
  for (Eigen::Index k = 0; k < after.rows(); ++k) {
    const Point p = after.row(k).transpose(), moved = p - Point(before.row(k).transpose());
    const double s = (p - from).dot(along), t = (p - from).dot(across), depth_here = -p.z();
    const double outside = std::max({0.0, -s, s - length}), distance = std::hypot(outside, t);
    if (distance > 2.5 * radius) g.beyond = std::max(g.beyond, moved.norm());
    g.rim = std::max(g.rim, p.z());
    g.lowest = std::max(g.lowest, depth_here);
    if (s < radius || s > length - radius) continue;
    const auto slot = static_cast<std::size_t>(std::clamp(static_cast<int>(s / cell), 0, n - 1));
    if (std::abs(t) < cell) lowest[slot] = std::min(lowest[slot], depth_here);
    if (std::abs(t) < cell) g.deepest = std::max(g.deepest, depth_here);
    if (depth_here > 0.5 * depth) {
      left[slot] = std::max(left[slot], -t);
      right[slot] = std::max(right[slot], t);
    }
    if (std::abs(t) < 2.5 * radius) {
      const auto bin = static_cast<std::size_t>(std::lround(t / (2 * cell)) + m);
      if (bin < sum.size()) {
        sum[bin] += depth_here;
        count[bin] += 1;
      }
    }
  }
  g.shallowest = 1e300;
  for (std::size_t k = 0; k < lowest.size(); ++k) {
    if (lowest[k] < 1e299) g.shallowest = std::min(g.shallowest, lowest[k]);
    g.width = std::max(g.width, left[k] + right[k]);
  }
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] /= std::max(count[k], 1.0);
  for (const int sign : {-1, 1}) {
    double deepest = -1e300;  // from outside towards the bottom
    for (int k = m; k >= 0; --k) {
      const double here = sum[static_cast<std::size_t>(m + sign * k)];
      deepest = std::max(deepest, here);
      g.ripple = std::max(g.ripple, deepest - here);
    }
  }
  return g;
}

inline Groove groove_of(const Surface& displaced, const Surface& flat, const Point& from,
                        const Point& to, double radius, double depth) {
  return groove_of(std::vector{&displaced}, std::vector{&flat}, from, to, radius, depth);
}

}  // namespace knead::testing
