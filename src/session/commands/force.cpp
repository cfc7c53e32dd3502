#include "force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/scene/places.hpp"

namespace knead {

std::span<const Choice> choices(PointForceKind) {
  static constexpr Choice list[] = {{"spring", PointForceKind::spring, "draws the point to `to`"},
                                    {"volcano", PointForceKind::volcano, "drives it away from there"}};
  return list;
}

void describe(ForceCommand& c, Fields& fields) {
  fields.name("force", "a force on one surface point, until `remove`");
  fields.add("name", c.force.name, {.help = "what `remove` calls it"});
  fields.add("kind", c.force.kind);
  fields.add("at", c.force.at,
             {.help = "`[s, t]`: the surface point", .unit = Unit::fraction, .presence = Presence::required});
  fields.add("to", c.force.to, {.help = "`[x, y, z]`", .unit = Unit::length, .presence = Presence::required});
  fields.add("strength", c.force.strength, {.help = "spring constant, or k of the volcano's k/r²"});
  fields.add("core", c.force.core,
             {.help = "distance within which the force of a volcano no longer grows", .unit = Unit::length});
}

template <>
Expected<void> Executor::execute(const ForceCommand& c) {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  if (auto u = parameters_at(*(*surface)->current, c.force.at); !u) return std::unexpected(u.error());
  if (!(c.force.strength >= 0 && c.force.strength <= max_tool_stiffness)) {
    return input_error(fmt::format("{} is not a strength", c.force.strength), "strength",
                       fmt::format("use a number from 0 to {}", max_tool_stiffness));
  }
  if (!(std::isfinite(c.force.core) && c.force.core > 0)) {
    return input_error(fmt::format("{} is not a length", c.force.core), "core", "use a number > 0");
  }
  SceneForce force = c.force;
  force.surface = *state.selected;
  const auto same = std::ranges::find(state.forces, force.name, &SceneForce::name);
  if (same != state.forces.end()) {
    *same = std::move(force);
  } else {
    state.forces.push_back(std::move(force));
  }
  return {};
}

}  // namespace knead
