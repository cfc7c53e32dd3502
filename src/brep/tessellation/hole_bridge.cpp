#include "hole_bridge.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "orientation.hpp"

namespace knead {
namespace {

using Eigen::Vector2d;

bool precedes(const Vector2d& p, const Vector2d& q) {
  return p.x() < q.x() || (p.x() == q.x() && p.y() < q.y());
}

/// How a direction lies to the inner angle of a corner.
enum class Facing { outside, along_a_side, inside };

class Bridges {
 public:
  explicit Bridges(std::span<const Vector2d> points) : points_(points) {}

  void join(Ring& ring, const Ring& hole) const {
    std::size_t first = first_of(hole);
    const Vector2d p = at(hole[first]);
    const std::size_t target = touching(ring, hole, first).value_or(visible(ring, p));
    if (at(ring[target]) != p) first = corner_facing(hole, first, at(ring[target]));
    Ring joined(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(target) + 1);
    for (std::size_t k = 0; k <= hole.size(); ++k)
      joined.push_back(hole[(first + k) % hole.size()]);
    joined.insert(joined.end(), ring.begin() + static_cast<std::ptrdiff_t>(target), ring.end());
    ring = std::move(joined);
  }

  [[nodiscard]] std::size_t first_of(const Ring& ring) const {
    const auto first = std::ranges::min_element(
        ring, [&](std::uint32_t a, std::uint32_t b) { return precedes(at(a), at(b)); });
    return static_cast<std::size_t>(first - ring.begin());
  }
  [[nodiscard]] const Vector2d& at(std::uint32_t k) const { return points_[k]; }

 private:
  /// A side by its ends in the order of the sweep.
  struct Side {
    Vector2d begin, end;
  };

  /// Whether `a` is above `b` where the sweep meets both; they do not cross.
  static bool above(const Side& a, const Side& b) {
    if (precedes(a.begin, b.begin)) {
      const int side = orientation(a.begin, a.end, b.begin);
      return (side != 0 ? side : orientation(a.begin, a.end, b.end)) < 0;
    }
    const int side = orientation(b.begin, b.end, a.begin);
    return (side != 0 ? side : orientation(b.begin, b.end, a.end)) > 0;
  }

  /// The sides of the ring next below and above p, of those that have the polygon between them and
  /// p.
  [[nodiscard]] std::pair<std::optional<Side>, std::optional<Side>> strip(const Ring& ring,
                                                                          const Vector2d& p) const {
    std::optional<Side> below, over;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vector2d &a = at(ring[k]), &b = at(ring[(k + 1) % ring.size()]);
      const bool right = precedes(a, b);  // its left is above
      if (!right && !precedes(b, a)) continue;
      const Side side = right ? Side{a, b} : Side{b, a};
      if (!precedes(side.begin, p) || precedes(side.end, p)) continue;
      const int place = orientation(side.begin, side.end, p);
      if (right && place >= 0 && (!below || above(side, *below))) below = side;
      if (!right && place <= 0 && (!over || above(*over, side))) over = side;
    }
    return {below, over};
  }

  /// The corner that the bridge to p begins at; of rings that cross, the one nearest to p.
  [[nodiscard]] std::size_t visible(const Ring& ring, const Vector2d& p) const {
    const auto [below, over] = strip(ring, p);
    if (!below || !over) return nearest(ring, p);
    std::optional<std::size_t> best;
    Facing best_facing = Facing::outside;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vector2d& v = at(ring[k]);
      if (!precedes(v, p) || precedes(v, below->begin) || precedes(v, over->begin)) continue;
      if (best && precedes(v, at(ring[*best]))) continue;
      if (orientation(below->begin, below->end, v) < 0 ||
          orientation(over->begin, over->end, v) > 0)
        continue;
      const Facing facing_here = facing(ring, k, p);
      if (facing_here == Facing::outside) continue;
      if (best && v == at(ring[*best]) && facing_here <= best_facing) continue;
      best = k;
      best_facing = facing_here;
    }
    return best ? *best : nearest(ring, p);
  }

  [[nodiscard]] std::size_t nearest(const Ring& ring, const Vector2d& p) const {
    const auto found = std::ranges::min_element(
        ring, {}, [&](std::uint32_t k) { return (at(k) - p).squaredNorm(); });
    return static_cast<std::size_t>(found - ring.begin());
  }

  /// The corner of the ring at the first point of the hole, if there is one: where the hole begins
  /// in its inner angle.
  [[nodiscard]] std::optional<std::size_t> touching(const Ring& ring, const Ring& hole,
                                                    std::size_t first) const {
    const Vector2d& p = at(hole[first]);
    const auto there = std::ranges::find_if(ring, [&](std::uint32_t k) { return at(k) == p; });
    if (there == ring.end()) return std::nullopt;
    return corner_facing(ring, static_cast<std::size_t>(there - ring.begin()),
                         neighbour(hole, first, 1));
  }

  /// Of the corners at the place of corner k, the one in whose inner angle q lies.
  [[nodiscard]] std::size_t corner_facing(const Ring& ring, std::size_t k,
                                          const Vector2d& q) const {
    std::size_t best = k;
    Facing best_facing = Facing::outside;
    for (std::size_t j = 0; j < ring.size(); ++j) {
      if (at(ring[j]) != at(ring[k])) continue;
      const Facing facing_here = facing(ring, j, q);
      if (facing_here <= best_facing) continue;
      best = j;
      best_facing = facing_here;
    }
    return best;
  }

  /// The next corner at another place, forwards (1) or backwards (-1).
  [[nodiscard]] const Vector2d& neighbour(const Ring& ring, std::size_t k,
                                          std::ptrdiff_t way) const {
    const auto n = static_cast<std::ptrdiff_t>(ring.size());
    auto j = static_cast<std::ptrdiff_t>(k);
    do j = (j + way + n) % n;
    while (j != static_cast<std::ptrdiff_t>(k) &&
           at(ring[static_cast<std::size_t>(j)]) == at(ring[k]));
    return at(ring[static_cast<std::size_t>(j)]);
  }

  /// The inner angle of corner k is on the left of the way into and out of it.
  [[nodiscard]] Facing facing(const Ring& ring, std::size_t k, const Vector2d& q) const {
    const Vector2d &before = neighbour(ring, k, -1), &corner = at(ring[k]),
                   &after = neighbour(ring, k, 1);
    if (before == corner) return Facing::inside;  // a point
    const int turn = orientation(before, corner, after), out = orientation(corner, after, q),
              in = orientation(before, corner, q);
    if (turn == 0 && precedes(before, corner) == precedes(after, corner)) {  // a tip: all around it
      return out == 0 && precedes(q, corner) == precedes(after, corner) ? Facing::along_a_side
                                                                        : Facing::inside;
    }
    // Below half a turn on the left of both sides, above on the left of one of them.
    const auto [low, high] = std::minmax(in, out);
    const int side = turn > 0 ? low : turn < 0 ? high : out;
    return side > 0 ? Facing::inside : side == 0 ? Facing::along_a_side : Facing::outside;
  }

  std::span<const Vector2d> points_;
};

}  // namespace

Ring bridged(std::span<const Vector2d> points, Ring outline, std::vector<Ring> holes) {
  if (outline.empty()) return outline;
  const Bridges bridges(points);
  std::erase_if(holes, [](const Ring& hole) { return hole.empty(); });
  std::ranges::stable_sort(
      holes, precedes, [&](const Ring& hole) { return bridges.at(hole[bridges.first_of(hole)]); });
  for (const Ring& hole : holes) bridges.join(outline, hole);
  return outline;
}

}  // namespace knead
