#include "correspondence.hpp"

#include <cassert>
#include <cmath>

#include "knead/spline/evaluate.hpp"

namespace knead::morph {

Expected<Point> normal_at(const Surface& surface, const std::array<double, 2>& parameters) {
  Parameters<2> place(1, 2);
  place << parameters[0], parameters[1];
  const auto normals = unit_normals(surface, place);
  if (!normals) return std::unexpected(normals.error());
  return Point(normals->row(0).transpose());
}

Expected<Point> part_along_normal(const Point& displacement, const Surface& surface,
                                  const std::array<double, 2>& parameters) {
  const auto normal = normal_at(surface, parameters);
  if (!normal) return std::unexpected(normal.error());
  return Point(displacement.dot(*normal) * *normal);
}

Expected<Correspondences> correspond(const VisibleSearch& search,
                                     std::span<const FitSurface> surfaces,
                                     std::span<const Point> points,
                                     std::span<const Point> displacements,
                                     const CorrespondenceSettings& settings) {
  assert(points.size() == displacements.size());
  const auto feet = search.nearest(points, settings.reach);
  Correspondences result;
  double squares = 0;
  for (std::size_t k = 0; k < feet.size(); ++k) {
    const VisibleFoot& foot = feet[k];
    if (foot.surface < 0) {
      if (result.left_out++ >= Correspondences::most_listed) continue;
      constexpr double farther = 100;  // times the reach, to say how far it is
      result.listed.push_back(
          {k, points[k], search.nearest(points[k], farther * settings.reach).distance});
      continue;
    }
    Datum datum{foot.surface, foot.parameters, displacements[k], 1};
    if (settings.along_normal) {
      const auto along = part_along_normal(
          datum.displacement, *surfaces[static_cast<std::size_t>(foot.surface)].surface,
          foot.parameters);
      if (!along) return std::unexpected(along.error());
      datum.displacement = *along;
    }
    result.data.push_back(datum);
    result.numbers.push_back(k);
    result.largest_distance = std::max(result.largest_distance, foot.distance);
    squares += foot.distance * foot.distance;
  }
  if (!result.data.empty())
    result.rms_distance = std::sqrt(squares / static_cast<double>(result.data.size()));
  return result;
}

}  // namespace knead::morph
