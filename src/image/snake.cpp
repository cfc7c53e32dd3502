#include "knead/image/snake.hpp"

#include <fmt/format.h>

#include <cmath>

#include "moving_snake.hpp"

namespace knead {

Expected<void> check_settings(const SnakeSettings& s) {
  const struct {
    const char* name;
    double value, least, most;
  } numbers[] = {{"degree", double(s.degree), 2, 7},
                 {"control_points", double(s.control_points), double(s.degree + 1), 100000},
                 {"units", s.units, 0, 1e9},
                 {"alpha", s.alpha, 0, 1e12},
                 {"beta", s.beta, 0, 1e12},
                 {"gamma", s.gamma, 1e-12, 1e12},
                 {"band", s.band, 0, 1e6},
                 {"local", s.local, 0, 1},
                 {"redistribute", double(s.redistribute), 0, 1e7},
                 {"end_tension", s.end_tension, 0, 1e6},
                 {"balloon", s.balloon, -1e12, 1e12},
                 {"max_move", s.max_move, 1e-6, 1e6},
                 {"max_iterations", double(s.max_iterations), 1, 1e7},
                 {"motion", s.motion, 0, 1e6},
                 {"refine", s.refine, 0, 1e6},
                 {"max_control_points", double(s.max_control_points), 1, 100000}};
  for (const auto& [name, value, least, most] : numbers) {
    if (value >= least && value <= most) continue;
    return input_error(fmt::format("{} is out of range", value), name, fmt::format("use {} to {}", least, most));
  }
  for (const SnakeSpring& spring : s.springs) {
    if (!(spring.at >= 0 && spring.at <= 1)) return input_error("it is beyond the snake", "springs", "use at 0 to 1");
    if (!(spring.strength >= 0)) return input_error("the strength is negative", "springs", "use 0 or more");
  }
  for (const SnakeVolcano& volcano : s.volcanoes) {
    if (!(volcano.radius > 0)) return input_error("the radius is not positive", "volcanoes", "use more than 0");
  }
  return {};
}

Expected<Curve> curve_through(std::span<const std::array<double, 2>> points, const SnakeSettings& settings) {
  if (auto checked = check_settings(settings); !checked) return std::unexpected(checked.error());
  if (points.size() < (settings.closed ? 3U : 2U)) {
    return input_error(fmt::format("{} points make no contour", points.size()), "points",
                       settings.closed ? "give 3 or more" : "give 2 or more");
  }
  const double length = chord_length(points, settings.closed), units = settings.units > 0 ? settings.units : length;
  const int spans = settings.closed ? settings.control_points : settings.control_points - settings.degree;
  std::vector<double> breaks;
  for (int k = 0; k <= spans; ++k) breaks.push_back((units > 0 && std::isfinite(units) ? units : 1) * k / spans);
  const auto c = fitted({points.begin(), points.end()}, breaks, settings);
  if (!c) return std::unexpected(c.error());
  const auto net = SnakeNet::create(breaks, settings, true);
  return net ? net->curve(*c) : std::unexpected(net.error());
}

}  // namespace knead
