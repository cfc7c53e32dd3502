#include "stamp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "brush.hpp"

namespace knead {
namespace {

constexpr int stamp_nodes = 97;  // per direction, of a shape
// Down one ray; one that grazes the shape for so long has met it.
constexpr int most_ray_steps = 1000;
constexpr double seen_share = 1e-9;  // of the size: a ray that comes so near has met the shape

/// Where a ray downwards at (x, y) meets the shape; −∞ where it misses it.
///
/// Sphere tracing (J. C. Hart, 1996): nothing is nearer than the distance, so that a step of it
/// cannot pass through the shape. Steps shrink geometrically towards a surface that is met at an
/// angle.
double seen_from_above(const PlacedShape& shape, double x, double y, double top, double bottom) {
  double z = top;
  for (int k = 0; k < most_ray_steps; ++k) {
    const double distance = shape.nearest({x, y, z}).distance;
    if (distance <= seen_share * (top - bottom)) return z;
    z -= distance;
    if (z < bottom) return -std::numeric_limits<double>::infinity();
  }
  return z;
}

}  // namespace

// Bilinear: the pattern is as continuous as its grid, and a step in it stays within a cell.
double StampPattern::at(double xi, double eta) const {
  if (empty() || std::abs(xi) > 1 || std::abs(eta) > 1) return 0;
  const int rows = static_cast<int>(heights.size()) / columns;
  const double x = 0.5 * (xi + 1) * (columns - 1), y = 0.5 * (1 - eta) * (rows - 1);
  const int l = std::clamp(static_cast<int>(x), 0, columns - 2),
            k = std::clamp(static_cast<int>(y), 0, rows - 2);
  const auto node = [&](int row, int column) {
    return heights[static_cast<std::size_t>(row * columns + column)];
  };
  const double s = x - l, t = y - k;
  return (1 - t) * ((1 - s) * node(k, l) + s * node(k, l + 1)) +
         t * ((1 - s) * node(k + 1, l) + s * node(k + 1, l + 1));
}

double stamp_rim(double xi, double eta, double core) {
  return brush_falloff(std::abs(xi), 1, core) * brush_falloff(std::abs(eta), 1, core);
}

// Rays begin a little above the box and end a little below it, or rounding of its bounds would
// decide whether they meet a face there. Where all seen is level within 1e-6 the relief has no
// scale, and the stamp is the shape's outline.
Expected<StampPattern> stamp_of(const Shape& shape, double width) {
  const auto placed = PlacedShape::create(shape);
  if (!placed) return std::unexpected(placed.error());
  const BoundingBox box = placed->bounding_box();
  const Point middle = 0.5 * (box.lower + box.upper);
  const double half = 0.5 * (box.upper - box.lower).head<2>().maxCoeff() / width;
  if (!std::isfinite(half) || !middle.allFinite()) {
    return input_error("this shape has no bounds, and no height over a square", "shape",
                       "use another shape, or give a `pattern`");
  }
  const double margin = 0.01 * (box.upper.z() - box.lower.z()) + 1e-6 * half;
  StampPattern pattern{stamp_nodes, {}};
  for (int k = 0; k < stamp_nodes; ++k) {
    for (int l = 0; l < stamp_nodes; ++l) {
      const double xi = -1 + 2. * l / (stamp_nodes - 1), eta = 1 - 2. * k / (stamp_nodes - 1);
      pattern.heights.push_back(seen_from_above(*placed, middle.x() + half * xi,
                                                middle.y() + half * eta, box.upper.z() + margin,
                                                box.lower.z() - margin));
    }
  }
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const double z : pattern.heights) {
    if (!std::isfinite(z)) continue;
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  const bool level = !(highest - lowest > 1e-6 * half);
  for (double& z : pattern.heights)
    z = !std::isfinite(z) ? 0 : level ? 1 : (z - lowest) / (highest - lowest);
  return pattern;
}

}  // namespace knead
