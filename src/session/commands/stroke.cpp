#include "stroke.hpp"

#include <fmt/format.h>

#include "session/acts/limits.hpp"
#include "session/acts/selection.hpp"
#include "session/acts/stepping.hpp"
#include "session/gestures/stroking.hpp"

namespace knead {
namespace {

/// Whether the stroke leaves its dents as it goes.
bool leaves_along(const StrokeCommand& c, const Scene& scene) {
  if (c.plastic && c.plastic != StrokePlasticity::material)
    return c.plastic == StrokePlasticity::along;
  return c.open.value_or(false) ||
         (scene.selected &&
          scene.surfaces[static_cast<std::size_t>(*scene.selected)].plastic.along);
}

}  // namespace

std::span<const Choice> choices(StrokePlasticity) {
  static constexpr Choice list[] = {
      {"material", StrokePlasticity::material, "as the material has it"},
      {"along", StrokePlasticity::along, "as the tool goes"},
      {"release", StrokePlasticity::release, "when it is lifted"}};
  return list;
}

void describe(StrokeCommand& c, Fields& fields) {
  fields.name("stroke", "press a tool along a path and take it back, as one command");
  fields.add("tool", c.tool, {.help = "its name", .fallback = "the only tool"});
  fields.add(
      "path", c.path,
      {.help = "`[[x, y, z], …]`, positions of its centre; empty to lift a tool that is down",
       .unit = Unit::length,
       .presence = Presence::required});
  fields.add("steps", c.steps,
             {.help = "at each position, where the shape at the end stays", .range = at_least(1)});
  fields.add(
      "plasticity", c.plasticity,
      {.help = "share of the displacement that becomes rest shape, of what the material lets stay",
       .unit = Unit::fraction,
       .range = between(0, 1)});
  fields.add("plastic", c.plastic,
             {.help = "when what the tool does becomes the shape", .fallback = "`\"material\"`"});
  fields.add("open", c.open,
             {.help = "the tool stays down, and the next stroke of this tool continues this one; "
                      "any other command lifts the tool first"});
  fields.add("relative", c.relative,
             {.help = "the path is measured from where the tool is, in fractions of the diagonal"});
  describe_allowance(c.allow, fields);
}

Expected<void> execute(const StrokeCommand& c, Act& act) {
  if (act.state.stroke &&
      (c.plastic == StrokePlasticity::release || (c.tool && *c.tool != act.state.stroke->tool))) {
    if (auto lifted = Stroke(act).lift(); !lifted) return lifted;
  }
  auto tool = find_tool(act, c.tool             ? c.tool
                             : act.state.stroke ? std::optional(act.state.stroke->tool)
                                                : std::nullopt);
  if (!tool) return std::unexpected(tool.error());
  if (c.path.empty() && !act.state.stroke) {
    return input_error("the path has no positions", "path", "give one or more: [[x, y, z], ...]");
  }
  if (auto few = check_steps(c.steps, c.path.size()); !few) return few;
  const auto length = diagonal(act);
  if (!length) return std::unexpected(length.error());
  const PlacedShape before = (*tool)->shape;
  const Placement& at = before.placement();
  const Point home = act.state.stroke ? act.state.stroke->home : at.position;
  std::vector<Point> points;
  for (const Vector3& given : c.path) {
    points.emplace_back(given[0], given[1], given[2]);
    if (c.relative) points.back() = home + *length * points.back();
  }
  if (act.state.stroke || leaves_along(c, act.state)) {
    return make(Stroke(act), {(*tool)->name, c.plasticity}, points, c.open.value_or(false));
  }
  const auto index = static_cast<std::size_t>(*tool - act.state.tools.data());
  const int total = c.steps * static_cast<int>(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    auto moved = before.moved(at.rotation, points[k]);
    if (!moved) return std::unexpected(moved.error().within(fmt::format("path[{}]", k)));
    act.state.tools[index].shape = std::move(*moved);
    const auto made = run(act, {.count = c.steps,
                                .evolution = act.state.evolution,
                                .before = static_cast<int>(k) * c.steps,
                                .of = total});
    if (!made) return std::unexpected(made.error());
  }
  act.state.tools[index].shape = before;
  return yield(act, c.plasticity);
}

}  // namespace knead
