#include "ear_clipping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knead {
namespace {

using Eigen::Vector2d;
using Ring = std::vector<std::uint32_t>;  // indices of points; those at a bridge occur twice

class Clipper {
 public:
  explicit Clipper(std::span<const Vector2d> points) : points_(points) {}

  // Joins a hole to the ring: from its leftmost point to a visible point of the ring to the left.
  bool bridge(Ring& ring, const Ring& hole) const {
    std::size_t left = 0;
    for (std::size_t k = 1; k < hole.size(); ++k) {
      const Vector2d &p = at(hole[k]), &q = at(hole[left]);
      if (p.x() < q.x() || (p.x() == q.x() && p.y() < q.y())) left = k;
    }
    const auto target = visible(ring, at(hole[left]));
    if (!target) return false;
    Ring joined(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(*target) + 1);
    for (std::size_t k = 0; k <= hole.size(); ++k) joined.push_back(hole[(left + k) % hole.size()]);
    joined.insert(joined.end(), ring.begin() + static_cast<std::ptrdiff_t>(*target), ring.end());
    ring = std::move(joined);
    return true;
  }

  std::optional<std::vector<Triangle>> clip(Ring ring) const {
    std::vector<Triangle> triangles;
    const auto n = ring.size();
    if (n < 3) return triangles;
    std::vector<std::uint32_t> next(n), before(n);
    for (std::size_t k = 0; k < n; ++k) {
      next[k] = static_cast<std::uint32_t>((k + 1) % n);
      before[k] = static_cast<std::uint32_t>((k + n - 1) % n);
    }
    auto left = n;
    std::uint32_t k = 0;
    std::size_t idle = 0;
    bool flat = false;  // also ears without area, once no others are left
    while (left > 3) {
      const auto a = ring[before[k]], b = ring[k], c = ring[next[k]];
      if (is_ear(ring, next, before, k, flat)) {
        if (a != b && b != c && c != a) triangles.push_back({a, b, c});
        next[before[k]] = next[k];
        before[next[k]] = before[k];
        --left;
        idle = 0;
        flat = false;
        k = next[next[k]];  // every other one: fewer slivers
      } else {
        k = next[k];
        if (++idle <= left) continue;
        if (flat) return std::nullopt;
        flat = true;
        idle = 0;
      }
    }
    const Triangle last = {ring[before[k]], ring[k], ring[next[k]]};
    if (last[0] != last[1] && last[1] != last[2] && last[2] != last[0]) triangles.push_back(last);
    return triangles;
  }

 private:
  const Vector2d& at(std::uint32_t k) const { return points_[k]; }

  // Where a ray to the left meets the ring: the end of the first side hit, or a corner in front of it (Eberly).
  std::optional<std::size_t> visible(const Ring& ring, const Vector2d& p) const {
    double hit = -std::numeric_limits<double>::infinity();
    std::optional<std::size_t> best;
    const auto n = ring.size();
    for (std::size_t k = 0; k < n; ++k) {
      // The ring is counter-clockwise: seen from inside, sides on the left run downwards.
      const Vector2d &a = at(ring[k]), &b = at(ring[(k + 1) % n]);
      if (p.y() > a.y() || p.y() < b.y() || a.y() == b.y()) continue;
      const double x = a.x() + (p.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y());
      if (x > p.x() || x <= hit) continue;
      hit = x;
      best = a.x() < b.x() ? k : (k + 1) % n;
      if (x == p.x() && p.y() == a.y()) best = k;
      if (x == p.x() && p.y() == b.y()) best = (k + 1) % n;
    }
    if (!best || hit == p.x()) return best;
    // Corners within the triangle of p, the hit and the end of the side would be in the way: the one at the smallest
    // angle to the ray is itself visible.
    const Vector2d m = at(ring[*best]);
    const Vector2d h(hit, p.y());
    double steepest = std::numeric_limits<double>::infinity();
    auto result = *best;
    for (std::size_t k = 0; k < n; ++k) {
      const Vector2d& q = at(ring[k]);
      if (q.x() > p.x() || q.x() < std::min(m.x(), hit) || q.x() == p.x()) continue;
      const bool above = m.y() >= p.y();
      const bool within = above ? in_triangle(h, p, m, q) : in_triangle(h, m, p, q);
      if (!within) continue;
      const double slope = std::abs(q.y() - p.y()) / (p.x() - q.x());
      const bool nearer = slope == steepest && q.x() > at(ring[result]).x();
      if ((slope < steepest || nearer) && locally_inside(ring, k, p)) {
        steepest = slope;
        result = k;
      }
    }
    return result;
  }

  bool locally_inside(const Ring& ring, std::size_t k, const Vector2d& p) const {
    const auto n = ring.size();
    const Vector2d &a = at(ring[(k + n - 1) % n]), &b = at(ring[k]), &c = at(ring[(k + 1) % n]);
    if (doubled_area(a, b, c) < 0) return doubled_area(b, p, a) < 0 || doubled_area(b, c, p) > 0 || p == b;
    return doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0;
  }

  static bool in_triangle(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& p) {
    return doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0;
  }

  bool is_ear(const Ring& ring, const std::vector<std::uint32_t>& next, const std::vector<std::uint32_t>& before,
              std::uint32_t k, bool flat) const {
    const Vector2d &a = at(ring[before[k]]), &b = at(ring[k]), &c = at(ring[next[k]]);
    const double area = doubled_area(a, b, c);
    if (area < 0 || (area == 0 && !flat)) return false;
    if (area == 0) return true;
    const Vector2d lower = a.cwiseMin(b).cwiseMin(c), upper = a.cwiseMax(b).cwiseMax(c);
    for (auto i = next[next[k]]; i != before[k]; i = next[i]) {
      const Vector2d& p = at(ring[i]);
      if (p.x() < lower.x() || p.x() > upper.x() || p.y() < lower.y() || p.y() > upper.y()) continue;
      if (p == a || p == b || p == c) continue;
      if (!in_triangle(a, b, c, p)) continue;
      // Only a reflex corner, which bulges into the ring, can be in the way.
      if (doubled_area(at(ring[before[i]]), p, at(ring[next[i]])) <= 0) return false;
    }
    return true;
  }

  std::span<const Vector2d> points_;
};

}  // namespace

std::optional<std::vector<Triangle>> clip_ears(std::span<const Vector2d> points, std::span<const std::uint32_t> sizes) {
  const Clipper clipper(points);
  std::vector<Ring> rings;
  std::uint32_t at = 0;
  for (const auto size : sizes) {
    Ring& ring = rings.emplace_back();
    for (std::uint32_t k = 0; k < size; ++k) ring.push_back(at++);
  }
  if (rings.empty()) return std::vector<Triangle>();
  Ring ring = std::move(rings.front());
  rings.erase(rings.begin());
  // From left to right, so that everything to the left of a bridge is joined before it.
  const auto leftmost = [&](const Ring& hole) {
    double x = std::numeric_limits<double>::infinity();
    for (const auto k : hole) x = std::min(x, points[k].x());
    return x;
  };
  std::sort(rings.begin(), rings.end(), [&](const Ring& a, const Ring& b) { return leftmost(a) < leftmost(b); });
  for (const Ring& hole : rings) {
    if (!hole.empty() && !clipper.bridge(ring, hole)) return std::nullopt;
  }
  return clipper.clip(std::move(ring));
}

}  // namespace knead
