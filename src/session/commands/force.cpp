#include "force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/scene/places.hpp"

namespace knead {

std::span<const Choice> choices(PointForceKind) {
  static constexpr Choice list[] = {
      {"spring", PointForceKind::spring, "draws the point to `to`"},
      {"volcano", PointForceKind::volcano, "drives it away from there"},
      {"dead", PointForceKind::dead, "`vector`, whatever the point does"},
      {"line", PointForceKind::line, "`vector` per length of the rest shape, along `edge`"},
      {"moment", PointForceKind::moment, "`moment` per length of the rest shape, about `edge`, following it"}};
  return list;
}

void describe(ForceCommand& c, Fields& fields) {
  fields.name("force", "a force on one point or edge, until `remove`");
  fields.add("name", c.force.name, {.help = "what `remove` calls it"});
  fields.add("kind", c.force.kind);
  fields.add("at", c.force.at,
             {.help = "`[s, t]`: the surface point, of a curve `[s]`, of a volume `[s, t, r]`; of all kinds but line "
                      "and moment",
              .unit = Unit::fraction});
  fields.add("to", c.force.to, {.help = "`[x, y, z]`: of springs and volcanoes", .unit = Unit::length});
  fields.add("strength", c.force.strength, {.help = "spring constant, or k of the volcano's k/r²"});
  fields.add("core", c.force.core,
             {.help = "distance within which the force of a volcano no longer grows", .unit = Unit::length});
  fields.add(
      "vector", c.force.vector,
      {.help = "`[x, y, z]`: of a dead force, or of a line force per length; lengths and forces are those of the "
               "model, in `scaling` raw those of the file"});
  fields.add("edge", c.force.edge, {.help = "of a line force or a moment"});
  fields.add("moment", c.force.moment,
             {.help = "of shells: force times length per length, right-handed about the edge's direction"});
}

namespace {

/// Whether the force has all that its kind needs, and nothing that it does not have.
Expected<void> check_kind(const SceneForce& f) {
  const bool moment = f.kind == PointForceKind::moment, edge = moment || f.kind == PointForceKind::line;
  const bool vector = f.kind == PointForceKind::line || f.kind == PointForceKind::dead;
  const struct {
    const char* name;
    bool given, needed;
    const char* remedy;
  } fields[] = {{"at", f.at.has_value(), !edge, "give the surface point, as [0.5,0.5]"},
                {"to", f.to.has_value(), !vector && !moment, "give the place, as [0,0,1]"},
                {"vector", f.vector.has_value(), vector, "give the force, as [0,0,-1]"},
                {"edge", f.edge.has_value(), edge, "give the edge, as \"u1\""},
                {"moment", f.moment.has_value(), moment, "give the moment per length, as 1"}};
  for (const auto& [name, given, needed, remedy] : fields) {
    if (given == needed) continue;
    const std::string_view kind = choices(PointForceKind{})[static_cast<std::size_t>(f.kind)].name;
    if (needed) return input_error(fmt::format("a force of kind {} needs it", kind), name, remedy);
    return input_error(fmt::format("a force of kind {} has none", kind), name, "leave it out");
  }
  if (f.vector && !point_of(*f.vector).allFinite())
    return input_error("a force is not finite", "vector", "use numbers");
  if (f.moment && !std::isfinite(*f.moment)) return input_error("a moment is not finite", "moment", "use a number");
  return {};
}

}  // namespace

Expected<void> check_force(const SceneForce& force) {
  if (auto complete = check_kind(force); !complete) return complete;
  if (!(force.strength >= 0 && force.strength <= max_tool_stiffness)) {
    return input_error(fmt::format("{} is not a strength", force.strength), "strength",
                       fmt::format("use a number from 0 to {}", max_tool_stiffness));
  }
  if (std::isfinite(force.core) && force.core > 0) return {};
  return input_error(fmt::format("{} is not a length", force.core), "core", "use a number > 0");
}

void put_force(Scene& scene, SceneForce force) {
  const auto same = std::ranges::find(scene.forces, force.name, &SceneForce::name);
  if (same != scene.forces.end()) {
    scene.forces[static_cast<std::size_t>(same - scene.forces.begin())] = std::move(force);
  } else {
    scene.forces.push_back(std::move(force));
  }
}

template <>
Expected<void> Executor::execute(const ForceCommand& c) {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  if (auto complete = check_force(c.force); !complete) return complete;
  if (c.force.at) {
    if (auto u = parameters_at<2>(*(*surface)->current, *c.force.at); !u) return std::unexpected(u.error());
  }
  SceneForce force = c.force;
  force.surface = *state.selected;
  force.body = -1;
  put_force(state, std::move(force));
  return {};
}

}  // namespace knead
