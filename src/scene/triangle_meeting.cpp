#include "triangle_meeting.hpp"

#include <algorithm>
#include <cmath>

namespace knead {

std::optional<PlaneMeeting> meeting(const Point& from, const Point& to, const Patch& of,
                                    const std::array<std::uint32_t, 3>& corners, double tolerance,
                                    const Reach& reach) {
  const auto height = [&corners](const std::vector<Point>& p, const Point& x) {
    const Point &a = p[corners[0]], normal = (p[corners[1]] - a).cross(p[corners[2]] - a);
    return normal.dot(x - a) / normal.norm();
  };
  const double first = height(of.from, from), apart = std::abs(first);
  if (!(apart > reach.nearest)) return std::nullopt;
  const double last = height(of.to, to), closing = apart - (first > 0 ? last : -last);
  if (!(closing > tolerance && apart - tolerance - std::min(reach.along, closing) <= closing))
    return std::nullopt;
  PlaneMeeting result{apart / closing, closing, {}};
  const auto then = [time = result.time](const Point& a, const Point& b) {
    return Point((1 - time) * a + time * b);
  };
  const Point hit = then(from, to);
  std::array<Point, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = then(of.from[corners[k]], of.to[corners[k]]);
  const Point facet = (p[1] - p[0]).cross(p[2] - p[0]);
  const double area = facet.norm();
  for (std::size_t k = 0; k < 3; ++k) {
    const Point &q = p[(k + 1) % 3], side = p[(k + 2) % 3] - q;
    const double inside = facet.dot(side.cross(hit - q)) / area;  // twice an area
    if (!(inside >= -reach.aside * side.norm())) return std::nullopt;
    result.weights[k] = std::clamp(inside / area, 0.0, 1.0);
  }
  return result;
}

std::array<double, 2> place_in(const Patch& patch, const std::array<std::uint32_t, 3>& corners,
                               const std::array<double, 3>& weights) {
  std::array<double, 2> at = {0, 0};
  const double sum = weights[0] + weights[1] + weights[2];
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t d = 0; d < 2; ++d) at[d] += weights[k] / sum * patch.at[corners[k]][d];
  }
  return at;
}

std::vector<Point> normals_of(const Patch& patch) {
  std::vector<Point> normals(patch.from.size(), Point::Zero());
  for (const auto& [a, b, c] : patch.triangles) {
    const Point facet = (patch.from[b] - patch.from[a]).cross(patch.from[c] - patch.from[a]);
    for (const auto k : {a, b, c}) normals[k] += facet;
  }
  return normals;
}

bool faces_away(const Patch& patch, const std::array<std::uint32_t, 3>& corners,
                const Point& normal) {
  const Point& a = patch.from[corners[0]];
  return (patch.from[corners[1]] - a).cross(patch.from[corners[2]] - a).dot(normal) < 0;
}

}  // namespace knead
