#include "pin.hpp"

#include <fmt/format.h>

#include <utility>

#include "../components.hpp"
#include "scene/places.hpp"
#include "session/acts/holding.hpp"
#include "session/acts/selection.hpp"

namespace knead {

void describe(PinCommand& c, Fields& fields) {
  fields.name("pin", "hold control points or a point, in addition to those held already");
  fields.add("control_points", c.control_points,
             {.help = "`[[i, j], …]`, i along u and j along v, from 0 (of a curve `[i]`, of a "
                      "volume `[i, j, k]`); this or `at`. They are identified by number, so the "
                      "net cannot be refined while they are pinned"});
  fields.add("at", c.at,
             {.help = "`[s, t]`: a surface point; of a curve `[s]`, of a volume `[s, t, r]`",
              .unit = Unit::fraction,
              .range = between(0, 1)});
  fields.add("to", c.to,
             {.help = "`[x, y, z]` where that point goes",
              .unit = Unit::length,
              .fallback = "where it is"});
  fields.add("components", c.components,
             {.help = "the coordinates of that point that are held, as `\"z\"` or `\"xy\"`",
              .fallback = "`\"xyz\"`"});
}

namespace {

template <int D>
Expected<void> pin(Act& act, SceneShape<D>& s, const PinCommand& c) {
  constexpr const char* give_at = D == 2 ? "give at, the surface point" : "give at, the point";
  if (c.to && !c.at) return input_error("there is no point to move there", "to", give_at);
  if (c.control_points.empty() && !c.at) {
    return input_error("nothing is pinned", "control_points", "give control_points, or at");
  }
  const auto components = components_of(c.components);
  if (!components) return std::unexpected(components.error());
  if (c.components && !c.at) {
    return input_error("control points are pinned in all coordinates", "components", give_at);
  }
  const auto net = s.rest->net();
  for (std::size_t k = 0; k < c.control_points.size(); ++k) {
    const std::vector<int>& index = c.control_points[k];
    std::array<int, D> point{};
    bool exists = index.size() == D;
    for (std::size_t d = 0; d < D && exists; ++d) {
      point[d] = index[d];
      exists = index[d] >= 0 && index[d] < net[d];
    }
    if (!exists) {
      return input_error(fmt::format("there is no control point [{}]", fmt::join(index, ", ")),
                         fmt::format("control_points[{}]", k),
                         fmt::format("the net is {}, counted from 0", fmt::join(net, " by ")));
    }
    s.pins.insert(point);
  }
  if (!c.at) return D == 2 ? Expected<void>() : check_constraints(act);
  if (auto u = parameters_at<D>(*s.rest, *c.at); !u) return std::unexpected(u.error());
  PointPinOf<D> place{.to = c.to, .components = *components};
  std::ranges::copy(*c.at, place.at.begin());
  s.constraints.push_back({std::move(place), s.current});
  // Points belong to one surface.
  const std::vector<int> others = std::exchange(act.state.together, {});
  auto status = check_constraints(act);
  act.state.together = others;
  return status;
}

}  // namespace

Expected<void> execute(const PinCommand& c, Act& act) {
  if (act.state.body) return std::visit([&](auto& s) { return pin(act, s, c); }, *body(act));
  auto surface = selected(act);
  return surface ? pin(act, **surface, c) : std::unexpected(surface.error());
}

}  // namespace knead
