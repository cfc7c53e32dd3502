#include "pin.hpp"

#include <fmt/format.h>

#include <utility>

namespace knead {

template <>
Expected<void> Executor::execute(const PinCommand& c) {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  if (c.to && !c.at) return input_error("there is no point to bring there", "to", "give at, the surface point");
  if (c.control_points.empty() && !c.at) {
    return input_error("nothing is pinned", "control_points", "give control_points, or at");
  }
  const auto [m, n] = (*surface)->rest->net();
  for (std::size_t k = 0; k < c.control_points.size(); ++k) {
    const auto [i, j] = c.control_points[k];
    if (i < 0 || i >= m || j < 0 || j >= n) {
      return input_error(fmt::format("there is no control point [{}, {}]", i, j), fmt::format("control_points[{}]", k),
                         fmt::format("the net is {} by {}, counted from 0", m, n));
    }
    (*surface)->pins.insert({i, j});
  }
  if (!c.at) return {};
  // Points belong to one surface.
  const std::vector<int> others = std::exchange(state.together, {});
  auto done = keep(PointPin{*c.at, c.to});
  state.together = others;
  return done;
}

}  // namespace knead
