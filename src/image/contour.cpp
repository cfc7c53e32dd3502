#include <algorithm>
#include <cmath>

#include "contour_rows.hpp"
#include "knead/image/snake.hpp"
#include "knead/spline/evaluate.hpp"
#include "snake_net.hpp"

namespace knead {
namespace {

using Place = std::array<double, 2>;

double turn(const Place& a, const Place& b, const Place& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Strictly: segments that touch do not cross, as those that follow one another must not.
bool cross(const Place& a, const Place& b, const Place& c, const Place& d) {
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

}  // namespace

std::vector<Place> polyline(const SnakeResult& snake, int per_span) {
  const std::vector<double> breaks = breaks_of(snake.curve);
  std::vector<double> at;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    for (int i = 0; i < per_span; ++i)
      at.push_back(std::lerp(breaks[k], breaks[k + 1], i / double(per_span)));
  }
  if (!snake.closed) at.push_back(breaks.back());
  const auto places = evaluate(
      snake.curve, Parameters<1>(Eigen::Map<const Eigen::VectorXd>(at.data(), std::ssize(at))));
  std::vector<Place> result;
  if (!places) return result;
  for (Eigen::Index k = 0; k < places->points().rows(); ++k) {
    result.push_back({places->points()(k, 0), places->points()(k, 1)});
  }
  return result;
}

// Pairs of segments that are no neighbours, those apart along x skipped: O(segments²) comparisons
// of two numbers, for some hundred segments.
int crossings(const SnakeResult& snake) {
  std::vector<Place> line = polyline(snake);
  if (line.empty()) return 0;
  if (snake.closed) line.push_back(line.front());
  const std::size_t segments = line.size() - 1;
  int count = 0;
  for (std::size_t i = 0; i < segments; ++i) {
    const auto [left, right] = std::minmax(line[i][0], line[i + 1][0]);
    for (std::size_t j = i + 2; j < segments; ++j) {
      if (snake.closed && i == 0 && j + 1 == segments) continue;
      if (std::max(line[j][0], line[j + 1][0]) < left ||
          std::min(line[j][0], line[j + 1][0]) > right)
        continue;
      if (cross(line[i], line[i + 1], line[j], line[j + 1])) ++count;
    }
  }
  return count;
}

Image mask_of(const SnakeResult& snake, int width, int height) {
  Image mask{
      width, height,
      std::vector<double>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0)};
  const std::vector<Place> line = polyline(snake);
  if (!snake.closed) return mask;
  for_rows_inside(line, width, height, [&mask](int y, int from, int to) {
    for (int x = from; x <= to; ++x) mask.at(x, y) = 1;
  });
  return mask;
}

}  // namespace knead
