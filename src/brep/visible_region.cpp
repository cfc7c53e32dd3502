#include "knead/brep/visible_region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

using Eigen::Vector2d;

double distance_to_chord(const Point& p, const Point& a, const Point& b) {
  const Point way = b - a;
  const double length = way.squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(way) / length, 0.0, 1.0) : 0.0;
  return (p - a - t * way).norm();
}

}  // namespace

// The rule of even and odd crossings of a ray along x. Half-open comparisons in y count a corner
// once. O(chords): callers that ask for many points make a `VisibleMask`.
bool VisibleRegion::contains(const Vector2d& at) const {
  if (faces.empty()) return at.minCoeff() >= 0 && at.maxCoeff() <= 1;
  for (const auto& face : faces) {
    bool odd = false;
    for (const auto& loop : face) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vector2d &a = loop[k], &b = loop[(k + 1) % loop.size()];
        if ((a.y() > at.y()) != (b.y() > at.y()) &&
            at.x() < a.x() + (b.x() - a.x()) * (at.y() - a.y()) / (b.y() - a.y())) {
          odd = !odd;
        }
      }
    }
    if (odd) return true;
  }
  return false;
}

std::array<Vector2d, 2> VisibleRegion::extent() const {
  if (faces.empty()) return {Vector2d::Zero(), Vector2d::Ones()};
  Vector2d lower = Vector2d::Ones(), upper = Vector2d::Zero();
  for (const auto& face : faces) {
    for (const auto& loop : face) {
      for (const Vector2d& p : loop) {
        lower = lower.cwiseMin(p);
        upper = upper.cwiseMax(p);
      }
    }
  }
  return {lower.cwiseMax(Vector2d::Zero()), upper.cwiseMin(Vector2d::Ones())};
}

double VisibleRegion::distance(const Point& p, const std::vector<bool>& which) const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!which.empty() && !which[e]) continue;
    const auto& points = edges[e].points;
    if (points.size() == 1) least = std::min(least, (p - points[0]).norm());
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      least = std::min(least, distance_to_chord(p, points[k], points[k + 1]));
    }
  }
  return least;
}

std::array<double, 2> parameters_of(const Surface& surface, const Vector2d& at) {
  std::array<double, 2> result{};
  for (int d = 0; d < 2; ++d) {
    const Interval domain = surface.knots(d).domain();
    result[static_cast<std::size_t>(d)] =
        std::clamp(domain.lower + at[d] * domain.length(), domain.lower, domain.upper);
  }
  return result;
}

// The visible point of least cost by grids that shrink: 41 × 41 cells over the visible extent, then
// eight times 9 × 9 over 1.2 steps around the best so far, each with steps of about a quarter of
// those before: below 1e-6 of the extent in the end. Costs are distances with kinks (edges, tools),
// where a method of descent would stop; 2300 evaluations are acceptable, as this is asked once for
// each command.
Expected<std::optional<VisiblePoint>> visible_least(
    const Surface& surface, const VisibleRegion& region,
    const std::function<double(const Point&)>& cost) {
  constexpr int first = 41, later = 9, rounds = 8;
  auto [lower, upper] = region.extent();
  std::optional<VisiblePoint> best;
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round <= rounds; ++round) {
    const int count = round == 0 ? first : later;
    const Eigen::Vector2d step = (upper - lower) / count;
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        const Eigen::Vector2d at = lower + step.cwiseProduct(Eigen::Vector2d(i + 0.5, j + 0.5));
        if (at.minCoeff() < 0 || at.maxCoeff() > 1 || !region.contains(at)) continue;
        const auto place = evaluate_point<2>(surface, parameters_of(surface, at));
        if (!place) return std::unexpected(place.error());
        const double value = cost(*place);
        if (!(value < least)) continue;
        least = value;
        best = VisiblePoint{at, *place, value};
      }
    }
    if (!best) return best;
    lower = best->at - 1.2 * step;
    upper = best->at + 1.2 * step;
  }
  return best;
}

Expected<VisiblePoint> visible_middle(const Surface& surface, const VisibleRegion& region) {
  if (region.edges.empty()) {
    const Vector2d at(0.5, 0.5);
    const auto place = evaluate_point<2>(surface, parameters_of(surface, at));
    if (!place) return std::unexpected(place.error());
    return VisiblePoint{at, *place, 0};
  }
  auto best = visible_least(surface, region, [&](const Point& p) { return -region.distance(p); });
  if (!best) return std::unexpected(best.error());
  if (!*best)
    return numerical_error("nothing of the surface is visible", "at", "give a point (s, t)");
  (*best)->distance = -(*best)->distance;
  return **best;
}

Expected<VisiblePoint> visible_near(const Surface& surface, const VisibleRegion& region,
                                    const Point& place) {
  auto best = visible_least(surface, region, [&](const Point& p) { return (p - place).norm(); });
  if (!best) return std::unexpected(best.error());
  if (!*best)
    return numerical_error("nothing of the surface is visible", "at", "give a point (s, t)");
  return **best;
}

}  // namespace knead
