#include "knead/image/snake.hpp"

#include <fmt/format.h>

#include <cmath>

#include "moving_snake.hpp"

namespace knead {

// Even spans: of the length of the polygon, or of the units asked for, in which α and β count.
Expected<Curve> curve_through(std::span<const std::array<double, 2>> points,
                              const SnakeSettings& settings) {
  if (auto checked = check_settings(settings); !checked) return std::unexpected(checked.error());
  if (points.size() < (settings.closed ? 3U : 2U)) {
    return input_error(fmt::format("{} points make no contour", points.size()), "points",
                       settings.closed ? "give 3 or more" : "give 2 or more");
  }
  const double length = chord_length(points, settings.closed),
               units = settings.units > 0 ? settings.units : length;
  const int spans =
      settings.closed ? settings.control_points : settings.control_points - settings.degree;
  std::vector<double> breaks;
  for (int k = 0; k <= spans; ++k)
    breaks.push_back((units > 0 && std::isfinite(units) ? units : 1) * k / spans);
  const auto c = fitted({points.begin(), points.end()}, breaks, settings);
  if (!c) return std::unexpected(c.error());
  const auto net = SnakeNet::create(breaks, settings, true);
  return net ? net->curve(*c) : std::unexpected(net.error());
}

}  // namespace knead
