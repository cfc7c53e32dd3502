#include "parameter_region.hpp"

#include <algorithm>
#include <cmath>

#include "unwrapped_loop.hpp"

namespace knead {
namespace {

using Eigen::Vector2d;

constexpr int trials = 96;  // places for a cut

std::unexpected<Error> no_region(std::string what) {
  return std::unexpected(Error{ErrorKind::input, std::move(what)});
}

double turned(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

void shift(Polygon& polygon, int direction, double by) {
  for (auto& p : polygon) p.at[direction] += by;
}

bool cross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const double s = turned(a, b, c), t = turned(a, b, d), u = turned(c, d, a), v = turned(c, d, b);
  return ((s > 0) != (t > 0)) && ((u > 0) != (v > 0)) && s != t;
}

/// Whether the segment from a to b meets no edge of the loops, shifted by whole turns; edges that
/// end in a or b do not count.
class Sight {
 public:
  Sight(const ParameterSpace& space, const std::vector<const Unwrapped*>& loops)
      : space_(space), loops_(loops) {}

  bool clear(const Vector2d& a, const Vector2d& b) const {
    for (const Unwrapped* loop : loops_) {
      const auto& points = loop->points;
      for (std::size_t k = 0; k < points.size(); ++k) {
        Vector2d from = points[k].at, to = points[(k + 1) % points.size()].at;
        if (k + 1 == points.size()) {
          for (int d = 0; d < 2; ++d)
            to[d] += space_.periods[std::size_t(d)] * loop->winding[std::size_t(d)];
        }
        if (!clear_of(a, b, from, to)) return false;
      }
    }
    return true;
  }

 private:
  bool clear_of(const Vector2d& a, const Vector2d& b, const Vector2d& from,
                const Vector2d& to) const {
    // Turns that bring the edge near the segment.
    std::array<int, 2> lower = {0, 0}, upper = {0, 0};
    for (int d = 0; d < 2; ++d) {
      const double period = space_.periods[std::size_t(d)];
      if (!(period > 0)) continue;
      lower[std::size_t(d)] =
          static_cast<int>(std::floor((std::min(a[d], b[d]) - std::max(from[d], to[d])) / period));
      upper[std::size_t(d)] =
          static_cast<int>(std::ceil((std::max(a[d], b[d]) - std::min(from[d], to[d])) / period));
    }
    for (int i = lower[0]; i <= upper[0]; ++i) {
      for (int j = lower[1]; j <= upper[1]; ++j) {
        const Vector2d by(i * space_.periods[0], j * space_.periods[1]);
        const Vector2d p = from + by, q = to + by;
        const double near = 1e-9 * (a - b).norm();
        const auto same = [near](const Vector2d& x, const Vector2d& y) {
          return (x - y).norm() <= near;
        };
        if (same(p, a) || same(p, b) || same(q, a) || same(q, b)) continue;
        if (cross(a, b, p, q)) return false;
      }
    }
    return true;
  }

  const ParameterSpace& space_;
  const std::vector<const Unwrapped*>& loops_;
};

// From point k once around to point k again, one turn further.
Polygon round_from(const Unwrapped& loop, std::size_t k, int d, double period) {
  Polygon result;
  const auto n = loop.points.size();
  const double whole = period * loop.winding[static_cast<std::size_t>(d)];
  for (std::size_t i = 0; i <= n; ++i) {
    RegionPoint p = loop.points[(k + i) % n];
    if (k + i >= n) p.at[d] += whole;
    result.push_back(p);
  }
  return result;
}

// The strip between two loops that wind in direction d, `below` towards larger parameters.
std::optional<Polygon> strip(const Unwrapped& below, const Unwrapped& above, int d, double period,
                             const Sight& sight) {
  struct Cut {
    double length;
    std::size_t from, to;
    double shift;
  };
  std::vector<Cut> cuts;
  const auto m = below.points.size(), n = above.points.size();
  // All pairs of points, shortest first: the first pair in sight of each other is cut along. Long
  // loops are thinned on one side, which bounds memory and the sort.
  const auto stride = std::max<std::size_t>(1, m * n / 60'000);
  for (std::size_t i = 0; i < m; i += stride) {
    for (std::size_t j = 0; j < n; ++j) {
      Vector2d way = above.points[j].at - below.points[i].at;
      const double by = -period * std::round(way[d] / period);
      way[d] += by;
      cuts.push_back({way.norm(), i, j, by});
    }
  }
  std::sort(cuts.begin(), cuts.end(),
            [](const Cut& a, const Cut& b) { return a.length < b.length; });
  for (const Cut& cut : cuts) {
    Vector2d to = above.points[cut.to].at;
    to[d] += cut.shift;
    if (!sight.clear(below.points[cut.from].at, to)) continue;
    Polygon result = round_from(below, cut.from, d, period);
    Polygon back = round_from(above, cut.to, d, period);
    // Back in the other direction: from the end of the first one.
    const bool same_way = below.winding[std::size_t(d)] == above.winding[std::size_t(d)];
    if (same_way) std::reverse(back.begin(), back.end());
    shift(back, d,
          cut.shift + period * below.winding[std::size_t(d)] -
              (same_way ? period * above.winding[std::size_t(d)] : 0));
    add_between(result, result.back().at, back.front().at);
    result.insert(result.end(), back.begin(), back.end());
    add_between(result, result.back().at, result.front().at);
    return result;
  }
  return std::nullopt;
}

// Between a loop and a pole at `end`: cut along the other direction.
std::optional<Polygon> cap(const Unwrapped& loop, double end, int d, double period,
                           const Sight& sight) {
  const auto n = loop.points.size();
  for (std::size_t k = 0; k < n; ++k) {
    Vector2d to = loop.points[k].at;
    to[1 - d] = end;
    if (!sight.clear(loop.points[k].at, to)) continue;
    Polygon result = round_from(loop, k, d, period);
    Vector2d corner = result.back().at, last = result.front().at;
    corner[1 - d] = last[1 - d] = end;
    add_between(result, result.back().at, corner);
    result.push_back({corner});
    add_between(result, corner, last);
    result.push_back({last});
    add_between(result, last, result.front().at);
    return result;
  }
  return std::nullopt;
}

// All of a closed surface, cut open where no loop is in the way.
std::optional<Polygon> everything(const ParameterSpace& space, const Sight& sight) {
  std::array<double, 2> lower = {0, 0}, length = {0, 0};
  for (std::size_t d = 0; d < 2; ++d) {
    if (space.periods[d] > 0) {
      length[d] = space.periods[d];
    } else if (space.poles[d][0] && space.poles[d][1]) {
      lower[d] = *space.poles[d][0];
      length[d] = *space.poles[d][1] - lower[d];
    } else {
      return std::nullopt;
    }
  }
  const bool both = space.periods[0] > 0 && space.periods[1] > 0;
  for (int i = 0; i < trials; ++i) {
    for (int j = 0; j < (both ? trials : 1); ++j) {
      std::array<double, 2> from = lower;
      if (space.periods[0] > 0) from[0] = length[0] * i / trials;
      if (space.periods[1] > 0) from[1] = length[1] * (both ? j : i) / trials;
      const auto corner = [&](double s, double t) {
        return Vector2d(from[0] + s * length[0], from[1] + t * length[1]);
      };
      if (space.periods[0] > 0 && !sight.clear(corner(0, 0), corner(0, 1))) continue;
      if (space.periods[1] > 0 && !sight.clear(corner(0, 0), corner(1, 0))) continue;
      Polygon result;
      const std::array<Vector2d, 5> corners = {corner(0, 0), corner(1, 0), corner(1, 1),
                                               corner(0, 1), corner(0, 0)};
      for (std::size_t side = 0; side < 4; ++side) {
        result.push_back({corners[side]});
        add_between(result, corners[side], corners[side + 1]);
      }
      return result;
    }
  }
  return std::nullopt;
}

// Moves a loop by whole turns into one of the polygons; false if it lies in none.
bool place(Polygon& loop, const ParameterSpace& space, const std::vector<RegionPart>& parts,
           std::size_t& which) {
  // A point just inside the loop would do as well; corners may touch the outline.
  Vector2d probe = (loop[0].at + loop[1 % loop.size()].at) / 2;
  for (which = 0; which < parts.size(); ++which) {
    Vector2d lower = parts[which].outer[0].at, upper = lower;
    for (const auto& p : parts[which].outer) {
      lower = lower.cwiseMin(p.at);
      upper = upper.cwiseMax(p.at);
    }
    std::array<int, 2> from = {0, 0}, to = {0, 0};
    for (int d = 0; d < 2; ++d) {
      const double period = space.periods[std::size_t(d)];
      if (!(period > 0)) continue;
      from[std::size_t(d)] = static_cast<int>(std::ceil((lower[d] - probe[d]) / period));
      to[std::size_t(d)] = static_cast<int>(std::floor((upper[d] - probe[d]) / period));
    }
    for (int i = from[0]; i <= to[0]; ++i) {
      for (int j = from[1]; j <= to[1]; ++j) {
        const Vector2d by(i * space.periods[0], j * space.periods[1]);
        if (!contains(parts[which].outer, probe + by)) continue;
        for (auto& p : loop) p.at += by;
        return true;
      }
    }
  }
  return false;
}

/// Loops that wind around the surface, all in one direction (−1: none), and loops that do not.
struct Bounds {
  int direction = -1;
  std::vector<Unwrapped> round;
  std::vector<Polygon> plain;
};

Expected<Bounds> sorted_by_winding(const std::vector<Unwrapped>& loops) {
  Bounds bounds;
  for (const auto& loop : loops) {
    if (loop.winding[0] == 0 && loop.winding[1] == 0) {
      if (loop.points.size() > 2) bounds.plain.push_back(loop.points);
      continue;
    }
    const int d = loop.winding[0] != 0 ? 0 : 1;
    if (loop.winding[std::size_t(1 - d)] != 0 || std::abs(loop.winding[std::size_t(d)]) != 1 ||
        (bounds.direction >= 0 && bounds.direction != d)) {
      return no_region("its bounds wind round the surface more than one way");
    }
    bounds.direction = d;
    bounds.round.push_back(loop);
  }
  return bounds;
}

double mean_height(const Unwrapped& loop, int d) {
  double sum = 0;
  for (const auto& p : loop.points) sum += p.at[1 - d];
  return sum / static_cast<double>(loop.points.size());
}

/// The region is above a loop that runs along u and below one that runs against it; the reverse
/// with u and v exchanged.
bool upwards(const Unwrapped& loop, int d) {
  return (loop.winding[std::size_t(d)] > 0) == (d == 0);
}

/// The parts between loops that wind in direction d, and between them and the poles.
Expected<void> between_round_loops(const ParameterSpace& space, std::vector<Unwrapped> round, int d,
                                   const Sight& sight, std::vector<RegionPart>& parts) {
  const double period = space.periods[std::size_t(d)], other = space.periods[std::size_t(1 - d)];
  const auto& ends = space.poles[std::size_t(1 - d)];
  for (auto& loop : round) {
    if (other > 0) shift(loop.points, 1 - d, -other * std::floor(mean_height(loop, d) / other));
  }
  std::sort(round.begin(), round.end(), [&](const Unwrapped& a, const Unwrapped& b) {
    return mean_height(a, d) < mean_height(b, d);
  });
  const bool lower_open = upwards(round.front(), d) || !(ends[0] || other > 0);
  // In a torus there is no lowest loop: one that faces downwards goes above all others, one turn
  // further.
  if (!lower_open && other > 0) {
    shift(round.front().points, 1 - d, other);
    std::rotate(round.begin(), round.begin() + 1, round.end());
  } else if (!lower_open && !(round.size() == 2 && upwards(round.back(), d) && !ends[1])) {
    auto polygon = cap(round.front(), *ends[0], d, period, sight);
    if (!polygon) return no_region("the surface cannot be cut open below its bounds");
    parts.push_back({*std::move(polygon), {}});
    round.erase(round.begin());
  }
  while (!round.empty()) {
    std::optional<Polygon> polygon;
    if (round.size() >= 2) {
      polygon = strip(round[0], round[1], d, period, sight);
      round.erase(round.begin(), round.begin() + 2);
    } else {
      // Alone: up to the pole it faces, or the only one.
      const auto end =
          upwards(round[0], d) ? (ends[1] ? ends[1] : ends[0]) : (ends[0] ? ends[0] : ends[1]);
      if (!end) return no_region("one of its bounds goes round the surface and none faces it");
      polygon = cap(round[0], *end, d, period, sight);
      round.clear();
    }
    if (!polygon) return no_region("the surface cannot be cut open between its bounds");
    parts.push_back({*std::move(polygon), {}});
  }
  return {};
}

/// Loops that do not wind, the largest first: holes of existing parts, or parts of their own.
Expected<void> add_plain_loops(const ParameterSpace& space, std::vector<Polygon> plain,
                               const Sight& sight, std::vector<RegionPart>& parts) {
  std::sort(plain.begin(), plain.end(), [](const Polygon& a, const Polygon& b) {
    return std::abs(doubled_area(a)) > std::abs(doubled_area(b));
  });
  const bool closed = (space.periods[0] > 0 || (space.poles[0][0] && space.poles[0][1])) &&
                      (space.periods[1] > 0 || (space.poles[1][0] && space.poles[1][1]));
  if (parts.empty() && closed && (plain.empty() || doubled_area(plain.front()) < 0)) {
    auto polygon = everything(space, sight);
    if (!polygon) return no_region("the surface cannot be cut open beside its bounds");
    parts.push_back({*std::move(polygon), {}});
  }
  for (auto& loop : plain) {
    std::size_t which = 0;
    if (place(loop, space, parts, which))
      parts[which].holes.push_back(std::move(loop));
    else
      parts.push_back({std::move(loop), {}});
  }
  return {};
}

/// Outer bounds to the left, holes to the right.
void orient(std::vector<RegionPart>& parts) {
  for (auto& part : parts) {
    if (doubled_area(part.outer) < 0) std::reverse(part.outer.begin(), part.outer.end());
    for (auto& hole : part.holes) {
      if (doubled_area(hole) > 0) std::reverse(hole.begin(), hole.end());
    }
  }
}

}  // namespace

double doubled_area(std::span<const RegionPoint> polygon) {
  double sum = 0;
  const Vector2d base = polygon.empty() ? Vector2d(Vector2d::Zero()) : polygon[0].at;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d a = polygon[k].at - base, b = polygon[(k + 1) % polygon.size()].at - base;
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

bool contains(std::span<const RegionPoint> polygon, const Vector2d& p) {
  bool inside = false;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d &a = polygon[k].at, &b = polygon[(k + 1) % polygon.size()].at;
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

Expected<std::vector<RegionPart>> parameter_region(const ParameterSpace& space,
                                                   std::span<const std::vector<LoopPoint>> loops) {
  std::vector<Unwrapped> all;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    auto loop = unwrap(space, loops[k], static_cast<int>(k));
    if (loop.points.size() >= 2) all.push_back(std::move(loop));
  }
  auto bounds = sorted_by_winding(all);
  if (!bounds) return std::unexpected(bounds.error());
  std::vector<const Unwrapped*> every;
  for (const auto& loop : all) every.push_back(&loop);
  const Sight sight(space, every);
  std::vector<RegionPart> parts;
  if (bounds->direction >= 0) {
    if (auto status =
            between_round_loops(space, std::move(bounds->round), bounds->direction, sight, parts);
        !status)
      return std::unexpected(status.error());
  }
  if (auto status = add_plain_loops(space, std::move(bounds->plain), sight, parts); !status)
    return std::unexpected(status.error());
  if (parts.empty()) return no_region("it has no bounds, and its surface has no end");
  orient(parts);
  return parts;
}

}  // namespace knead
