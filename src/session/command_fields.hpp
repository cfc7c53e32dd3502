#pragma once

#include <span>
#include <string_view>

#include "knead/session/command.hpp"

namespace knead {

/// A name of an enumeration's value in JSON.
template <class E>
struct Choice {
  std::string_view name;
  E value;
};

/// Whether a field may be left out.
enum class Presence { required, optional };

// One description per command serves parsing, writing and help. `visit_fields(command, visitor)` calls
//   visitor.field(name, presence, member, help)
//   visitor.choice(name, member, choices, help)
// for every field; all choices are optional.

inline constexpr Choice<RestMode> rest_modes[] = {{"shape", RestMode::shape}, {"none", RestMode::none}};
inline constexpr Choice<ToolMode> tool_modes[] = {{"collision", ToolMode::collision},
                                                  {"proximity", ToolMode::proximity}};
inline constexpr Choice<StepWeight> step_weights[] = {{"mass", StepWeight::mass}, {"identity", StepWeight::identity}};

template <class C>
struct CommandInfo;

#define KNEAD_COMMAND(Type, command_name, command_help_text)         \
  template <>                                                        \
  struct CommandInfo<Type> {                                         \
    static constexpr std::string_view name = command_name;           \
    static constexpr std::string_view help = command_help_text;      \
    template <class C, class V>                                      \
    static void visit([[maybe_unused]] C& c, [[maybe_unused]] V& v); \
  };                                                                 \
  template <class C, class V>                                        \
  void CommandInfo<Type>::visit([[maybe_unused]] C& c, [[maybe_unused]] V& v)

KNEAD_COMMAND(SelectCommand, "select", "choose the surface that the following commands act on") {
  v.field("surface", Presence::required, c.surface, "entity id as `knead info` lists it, \"#123\"");
}
KNEAD_COMMAND(MaterialCommand, "material", "resistance to stretch and bend, in the order 11, 12, 22") {
  v.field("alpha", Presence::optional, c.material.alpha, "stretch; alpha12² <= alpha11 alpha22");
  v.field("beta", Presence::optional, c.material.beta, "bend; none negative");
}
KNEAD_COMMAND(RestCommand, "rest", "make the present shape the rest shape; what the energy acts on") {
  v.choice("mode", c.mode, std::span<const Choice<RestMode>>(rest_modes),
           "shape: displacement from it; none: the shape itself");
}
KNEAD_COMMAND(HoldCommand, "hold", "hold the outer rows of control points on every side") {
  v.field("rows", Presence::optional, c.rows, "how many; 0 holds none");
}
KNEAD_COMMAND(PinCommand, "pin", "hold single control points, in addition to those held already") {
  v.field("control_points", Presence::required, c.control_points, "list of [i, j], counted from 0");
}
KNEAD_COMMAND(ReleaseCommand, "release", "free all held and pinned control points") {}
KNEAD_COMMAND(ToolCommand, "tool", "put a tool into the scene, or replace the one of that name") {
  v.field("name", Presence::optional, c.name, "what `move` and `remove` call it");
  v.field("shape", Presence::optional, c.shape, "sphere");
  v.field("radius", Presence::optional, c.radius, "length; default: 0.1 of the surface's bounding-box diagonal");
  v.field("position", Presence::optional, c.position, "[x, y, z] of the centre; this or `at` is needed");
  v.field("at", Presence::optional, c.at, "[s, t]: centre on the surface, at fractions 0 to 1 of its domain");
  v.choice("mode", c.mode, std::span<const Choice<ToolMode>>(tool_modes),
           "collision pushes out what has entered; proximity draws near");
  v.field("stiffness", Presence::optional, c.stiffness,
          "spring constant k >= 0; default: 1e4 for collision, 100 for proximity");
  v.field("range", Presence::optional, c.range, "reach of proximity, a length; default: half the radius");
  v.field("relative", Presence::optional, c.relative,
          "radius, range and position are fractions of the surface's bounding-box diagonal");
}
KNEAD_COMMAND(RemoveCommand, "remove", "take a tool out of the scene") {
  v.field("tool", Presence::optional, c.tool, "its name; default: the only tool");
}
KNEAD_COMMAND(MoveCommand, "move", "move a tool") {
  v.field("tool", Presence::optional, c.tool, "its name; default: the only tool");
  v.field("by", Presence::required, c.by, "[dx, dy, dz]");
  v.field("relative", Presence::optional, c.relative, "fractions of the surface's bounding-box diagonal, not lengths");
}
KNEAD_COMMAND(StepCommand, "step", "let the selected surface evolve under the tools") {
  v.field("count", Presence::optional, c.count, "number of steps");
  v.field("lambda", Presence::optional, c.lambda, "inverse step size >= 0");
  v.choice("weight", c.weight, std::span<const Choice<StepWeight>>(step_weights),
           "W of the step: mass matrix, or identity as in the thesis");
}
KNEAD_COMMAND(UndoCommand, "undo", "take back the last command") {}
KNEAD_COMMAND(RedoCommand, "redo", "do again what was taken back last") {}

#undef KNEAD_COMMAND

}  // namespace knead
