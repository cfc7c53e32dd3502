#include "force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/places.hpp"
#include "session/acts/selection.hpp"

namespace knead {

std::span<const Choice> choices(ForceKind) {
  static constexpr Choice list[] = {
      {"spring", ForceKind::spring, "draws the point to `to`"},
      {"volcano", ForceKind::volcano, "drives it away from there"},
      {"dead", ForceKind::dead, "`vector`, whatever the point does"},
      {"line", ForceKind::line, "`vector` per length of the rest shape, along `edge`"},
      {"moment", ForceKind::moment,
       "`moment` per length of the rest shape, about `edge`, following it"}};
  return list;
}

void describe(ForceCommand& c, Fields& fields) {
  fields.name("force", "a force on one point or edge, until `remove`");
  fields.add("name", c.name, {.help = "what `remove` calls it"});
  fields.add("kind", c.kind, {.help = "how it acts"});
  fields.add("at", c.at,
             {.help = "`[s, t]`: the surface point, of a curve `[s]`, of a volume `[s, t, r]`; of "
                      "all kinds but line and moment",
              .unit = Unit::fraction,
              .range = between(0, 1)});
  fields.add("to", c.to, {.help = "`[x, y, z]`: of springs and volcanoes", .unit = Unit::length});
  fields.add("strength", c.strength,
             {.help = "spring constant, or k of the volcano's k/r²",
              .range = between(0, max_tool_stiffness)});
  fields.add("core", c.core,
             {.help = "distance within which the force of a volcano no longer grows",
              .unit = Unit::length,
              .range = above(0)});
  fields.add("vector", c.vector,
             {.help = "`[x, y, z]`: of a dead force, or of a line force per length; lengths and "
                      "forces are those of the model, in `scaling` raw those of the file"});
  fields.add("edge", c.edge, {.help = "of a line force or a moment"});
  fields.add(
      "moment", c.moment,
      {.help =
           "of shells: force times length per length, right-handed about the edge's direction"});
}

namespace {

/// Whether the force has all that its kind needs, and nothing that it does not have.
Expected<void> check_kind(const ForceCommand& f) {
  const bool moment = f.kind == ForceKind::moment, edge = moment || f.kind == ForceKind::line;
  const bool vector = f.kind == ForceKind::line || f.kind == ForceKind::dead;
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
    const std::string_view kind = choices(ForceKind{})[static_cast<std::size_t>(f.kind)].name;
    if (needed) return input_error(fmt::format("a force of kind {} needs it", kind), name, remedy);
    return input_error(fmt::format("a force of kind {} has none", kind), name, "leave it out");
  }
  if (f.vector && !point_of(*f.vector).allFinite())
    return input_error("a force is not finite", "vector", "use numbers");
  if (f.moment && !std::isfinite(*f.moment))
    return input_error("a moment is not finite", "moment", "use a number");
  return {};
}

}  // namespace

Expected<Force> force_of(const ForceCommand& c) {
  if (auto valid = check_kind(c); !valid) return std::unexpected(valid.error());
  if (auto valid = check_ranges(type_of<ForceCommand>(), &c); !valid)
    return std::unexpected(valid.error());
  switch (c.kind) {
    case ForceKind::spring:
      return SpringForce{*c.at, *c.to, c.strength};
    case ForceKind::volcano:
      return VolcanoForce{*c.at, *c.to, c.strength, c.core};
    case ForceKind::dead:
      return DeadForce{*c.at, *c.vector};
    case ForceKind::line:
      return LineForce{*c.edge, *c.vector};
    default:
      return MomentForce{*c.edge, *c.moment};
  }
}

ForceCommand restated(const SceneForce& force) {
  ForceCommand c{.name = force.name, .kind = static_cast<ForceKind>(force.force.index())};
  std::visit(
      [&c](const auto& f) {
        if constexpr (requires { f.at; }) c.at = f.at;
        if constexpr (requires { f.to; }) c.to = f.to;
        if constexpr (requires { f.strength; }) c.strength = f.strength;
        if constexpr (requires { f.core; }) c.core = f.core;
        if constexpr (requires { f.vector; }) c.vector = f.vector;
        if constexpr (requires { f.edge; }) c.edge = f.edge;
        if constexpr (requires { f.moment; }) c.moment = f.moment;
      },
      force.force);
  return c;
}

void put_force(Scene& scene, SceneForce force) {
  const auto same = std::ranges::find(scene.forces, force.name, &SceneForce::name);
  if (same != scene.forces.end()) {
    scene.forces[static_cast<std::size_t>(same - scene.forces.begin())] = std::move(force);
  } else {
    scene.forces.push_back(std::move(force));
  }
}

Expected<void> execute(const ForceCommand& c, Act& act) {
  const SceneBody* const b = body(act);
  if (auto some = some_selected(act); !some) return some;
  if (b != nullptr && (c.kind == ForceKind::line || c.kind == ForceKind::moment)) {
    return input_error(fmt::format("a {} has no edges", kind_of(*b)), "kind",
                       "use spring, volcano or dead");
  }
  auto force = force_of(c);
  if (!force) return std::unexpected(force.error());
  const auto exists = [&]<int D>(const Spline<D>& shape) -> Expected<void> {
    if (!c.at) return {};
    const auto u = parameters_at<D>(shape, *c.at);
    return u ? Expected<void>() : std::unexpected(u.error());
  };
  auto there =
      b == nullptr
          ? exists(*act.state.surfaces[static_cast<std::size_t>(*act.state.selected)].current)
          : std::visit([&](const auto& s) { return exists(*s.current); }, *b);
  if (!there) return there;
  put_force(act.state, {.name = c.name,
                        .surface = b == nullptr ? *act.state.selected : -1,
                        .body = b == nullptr ? -1 : *act.state.body,
                        .force = *std::move(force)});
  return {};
}

}  // namespace knead
