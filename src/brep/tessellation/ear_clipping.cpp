#include "ear_clipping.hpp"

#include "hole_bridge.hpp"
#include "orientation.hpp"

namespace knead {
namespace {

using Eigen::Vector2d;

class Clipper {
 public:
  explicit Clipper(std::span<const Vector2d> points) : points_(points) {}

  // The ring is a linked list; k goes round it. Corners without area are cut only when a whole
  // round has found none with area: cut earlier, they would leave slivers that a later ear could
  // have contained. If a round finds not even these, sides cross.
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

  static bool in_triangle(const Vector2d& a, const Vector2d& b, const Vector2d& c,
                          const Vector2d& p) {
    return orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0;
  }

  bool is_ear(const Ring& ring, const std::vector<std::uint32_t>& next,
              const std::vector<std::uint32_t>& before, std::uint32_t k, bool flat) const {
    const Vector2d &a = at(ring[before[k]]), &b = at(ring[k]), &c = at(ring[next[k]]);
    const int turn = orientation(a, b, c);
    if (turn <= 0) return turn == 0 && flat;
    const Vector2d lower = a.cwiseMin(b).cwiseMin(c), upper = a.cwiseMax(b).cwiseMax(c);
    for (auto i = next[next[k]]; i != before[k]; i = next[i]) {
      const Vector2d& p = at(ring[i]);
      if (p.x() < lower.x() || p.x() > upper.x() || p.y() < lower.y() || p.y() > upper.y())
        continue;
      if (p == a || p == b || p == c) continue;
      if (!in_triangle(a, b, c, p)) continue;
      // Only a reflex corner, which bulges into the ring, can be in the way.
      if (orientation(at(ring[before[i]]), p, at(ring[next[i]])) <= 0) return false;
    }
    return true;
  }

  std::span<const Vector2d> points_;
};

}  // namespace

std::optional<std::vector<Triangle>> clip_ears(std::span<const Vector2d> points,
                                               std::span<const std::uint32_t> sizes) {
  std::vector<Ring> rings;
  std::uint32_t at = 0;
  for (const auto size : sizes) {
    Ring& ring = rings.emplace_back();
    for (std::uint32_t k = 0; k < size; ++k) ring.push_back(at++);
  }
  if (rings.empty()) return std::vector<Triangle>();
  Ring outline = std::move(rings.front());
  rings.erase(rings.begin());
  return Clipper(points).clip(bridged(points, std::move(outline), std::move(rings)));
}

}  // namespace knead
