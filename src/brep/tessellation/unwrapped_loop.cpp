#include "unwrapped_loop.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace knead {
namespace {

constexpr double most_line_pieces = 1000;  // of one straight line

}  // namespace

void add_between(Polygon& polygon, Eigen::Vector2d from, Eigen::Vector2d to) {
  const double steps = std::ceil((to - from).cwiseAbs().maxCoeff() - 1e-9);
  const int pieces = static_cast<int>(std::clamp(steps, 1.0, most_line_pieces));
  for (int k = 1; k < pieces; ++k) polygon.push_back({from + (to - from) * k / pieces});
}

// Starts at a point with both parameters, so that poles are always between two known ones, and
// returns to it at k = n: how far that image is from the first is the winding.
Unwrapped unwrap(const ParameterSpace& space, std::span<const LoopPoint> loop, int number) {
  Unwrapped result;
  const auto n = loop.size();
  std::size_t first = 0;
  while (first < n && (loop[first].free[0] || loop[first].free[1])) ++first;
  if (first == n) return result;
  Eigen::Vector2d before = loop[first].at;
  std::optional<RegionPoint> pole;
  std::array<bool, 2> free = {false, false};
  for (std::size_t k = 0; k <= n; ++k) {
    const auto index = (first + k) % n;
    const LoopPoint& p = loop[index];
    RegionPoint next{p.at, number, static_cast<int>(index)};
    if (p.free[0] || p.free[1]) {
      free = p.free;
      pole = next;
      continue;
    }
    for (int d = 0; d < 2; ++d) {
      const double period = space.periods[static_cast<std::size_t>(d)];
      if (period > 0) next.at[d] += period * std::round((before[d] - next.at[d]) / period);
    }
    if (pole) {
      for (int d = 0; d < 2; ++d) {
        if (!free[static_cast<std::size_t>(d)]) continue;
        const double period = space.periods[static_cast<std::size_t>(d)];
        const auto& ends = space.poles[static_cast<std::size_t>(1 - d)];
        const bool upper = !ends[0] || (ends[1] && std::abs(*ends[1] - pole->at[1 - d]) <
                                                       std::abs(*ends[0] - pole->at[1 - d]));
        // Downwards (d = 0) at the upper end; reversed if the pole is an end of u.
        const bool down = upper == (d == 0);
        const double near = 1e-6 * period;
        while (period > 0 && down && next.at[d] > before[d] - near) next.at[d] -= period;
        while (period > 0 && down && next.at[d] <= before[d] - period - near) next.at[d] += period;
        while (period > 0 && !down && next.at[d] < before[d] + near) next.at[d] += period;
        while (period > 0 && !down && next.at[d] >= before[d] + period + near) next.at[d] -= period;
        RegionPoint a = *pole, b = *pole;
        a.at[d] = before[d];
        b.at[d] = next.at[d];
        result.points.push_back(a);
        add_between(result.points, a.at, b.at);
        result.points.push_back(b);
      }
      pole.reset();
    }
    before = next.at;
    if (k < n)
      result.points.push_back(next);
    else {
      for (int d = 0; d < 2; ++d) {
        const double period = space.periods[static_cast<std::size_t>(d)];
        const double way = next.at[d] - result.points.front().at[d];
        if (period > 0)
          result.winding[static_cast<std::size_t>(d)] = static_cast<int>(std::lround(way / period));
      }
    }
  }
  return result;
}

}  // namespace knead
