#include "pin.hpp"

#include <fmt/format.h>

#include <utility>

#include "../components.hpp"
#include "knead/scene/places.hpp"

namespace knead {

void describe(PinCommand& c, Fields& fields) {
  fields.name("pin", "hold control points or a point, in addition to those held already");
  fields.add(
      "control_points", c.control_points,
      {.help = "`[[i, j], …]`, i along u and j along v, from 0 (of a curve `[i]`, of a volume `[i, j, k]`); this "
               "or `at`. They are identified by number, "
               "so the net cannot be refined while they are pinned"});
  fields.add("at", c.at,
             {.help = "`[s, t]`: a surface point; of a curve `[s]`, of a volume `[s, t, r]`", .unit = Unit::fraction});
  fields.add("to", c.to,
             {.help = "`[x, y, z]` where that point goes", .unit = Unit::length, .fallback = "where it is"});
  fields.add("components", c.components,
             {.help = "the coordinates of that point that are held, as `\"z\"` or `\"xy\"`", .fallback = "`\"xyz\"`"});
}

template <>
Expected<void> Executor::execute(const PinCommand& c) {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  if (c.to && !c.at) return input_error("there is no point to move there", "to", "give at, the surface point");
  if (c.control_points.empty() && !c.at) {
    return input_error("nothing is pinned", "control_points", "give control_points, or at");
  }
  const auto components = components_of(c.components);
  if (!components) return std::unexpected(components.error());
  if (c.components && !c.at) {
    return input_error("control points are pinned in all coordinates", "components", "give at, the surface point");
  }
  const auto [m, n] = (*surface)->rest->net();
  for (std::size_t k = 0; k < c.control_points.size(); ++k) {
    const std::vector<int>& index = c.control_points[k];
    if (index.size() != 2 || index[0] < 0 || index[0] >= m || index[1] < 0 || index[1] >= n) {
      return input_error(fmt::format("there is no control point [{}]", fmt::join(index, ", ")),
                         fmt::format("control_points[{}]", k),
                         fmt::format("the net is {} by {}, counted from 0", m, n));
    }
    (*surface)->pins.insert({index[0], index[1]});
  }
  if (!c.at) return {};
  if (auto u = parameters_at<2>(*(*surface)->rest, *c.at); !u) return std::unexpected(u.error());
  // Points belong to one surface.
  const std::vector<int> others = std::exchange(state.together, {});
  auto done = keep(PointPin{{(*c.at)[0], (*c.at)[1]}, c.to, *components});
  state.together = others;
  return done;
}

}  // namespace knead
