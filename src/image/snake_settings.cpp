#include "snake_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace knead {
namespace {

template <class T>
std::vector<double> numbers_of(const T& values) {
  std::vector<double> list;
  if constexpr (std::is_arithmetic_v<T>) {
    list.push_back(double(values));
  } else {
    for (const auto value : values) list.push_back(double(value));
  }
  return list;
}

bool finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double x) { return std::isfinite(x); });
}

}  // namespace

template <int D>
Expected<void> check_settings(const SnakeSettingsOf<D>& s) {
  struct Range {
    const char* name;
    double value, least, most;
  };
  std::vector<Range> ranges = {{"degree", double(s.degree), 2, 7}};
  for (const double count : numbers_of(s.control_points)) {
    ranges.push_back({"control_points", count, s.degree + 1.0, D == 1 ? 100000 : 1000});
  }
  for (const Range& range :
       {Range{"units", s.units, 0, 1e9}, Range{"alpha", s.alpha, 0, 1e12},
        Range{"beta", s.beta, 0, 1e12}, Range{"gamma", s.gamma, 1e-12, 1e12},
        Range{"band", s.band, 0, 1e6}, Range{"local", s.local, 0, 1},
        Range{"redistribute", double(s.redistribute), 0, 1e7},
        Range{"end_tension", s.end_tension, 0, 1e6}, Range{"balloon", s.balloon, -1e12, 1e12},
        Range{"max_move", s.max_move, 1e-6, 1e6},
        Range{"max_iterations", double(s.max_iterations), 1, 1e7},
        Range{"motion", s.motion, 0, 1e6}, Range{"refine", s.refine, 0, 1e6},
        Range{"max_control_points", double(s.max_control_points), 1, 100000}}) {
    ranges.push_back(range);
  }
  for (const auto& [name, value, least, most] : ranges) {
    if (value >= least && value <= most) continue;
    return input_error(fmt::format("{} is out of range", value), name,
                       fmt::format("use {} to {}", least, most));
  }
  for (const SnakeSpringOf<D>& spring : s.springs) {
    if (!std::ranges::all_of(numbers_of(spring.at), [](double at) { return at >= 0 && at <= 1; })) {
      return input_error(D == 1 ? "it is beyond the snake" : "it is beyond the surface", "springs",
                         "use at 0 to 1");
    }
    if (!finite(numbers_of(spring.to))) return input_error("the place is not finite", "springs");
    if (!(spring.strength >= 0))
      return input_error("the strength is negative", "springs", "use 0 or more");
  }
  for (const SnakeVolcanoOf<D>& volcano : s.volcanoes) {
    if (!finite(numbers_of(volcano.at)) || !std::isfinite(volcano.strength)) {
      return input_error("it is not finite", "volcanoes");
    }
    if (!(volcano.radius > 0))
      return input_error("the radius is not positive", "volcanoes", "use more than 0");
  }
  return {};
}

template Expected<void> check_settings(const SnakeSettingsOf<1>& settings);
template Expected<void> check_settings(const SnakeSettingsOf<2>& settings);

}  // namespace knead
