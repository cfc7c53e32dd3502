#include "stroke.hpp"

#include <fmt/format.h>

namespace knead {

void describe(StrokeCommand& c, Fields& fields) {
  fields.name("stroke", "press a tool along a path and take it back, as one command");
  fields.add("tool", c.tool, {.help = "its name", .fallback = "the only tool"});
  fields.add(
      "path", c.path,
      {.help = "`[[x, y, z], …]`, positions of its centre", .unit = Unit::length, .presence = Presence::required});
  fields.add("steps", c.steps, {.help = "at each position"});
  fields.add("plasticity", c.plasticity,
             {.help = "share of the displacement that becomes rest shape", .unit = Unit::fraction});
  fields.add("relative", c.relative,
             {.help = "the path is measured from where the tool is, in fractions of the diagonal"});
}

template <>
Expected<void> Executor::execute(const StrokeCommand& c) {
  auto tool = find_tool(c.tool);
  if (!tool) return std::unexpected(tool.error());
  if (c.path.empty()) return input_error("the path has no positions", "path", "give one or more: [[x, y, z], ...]");
  if (c.steps < 1) return input_error(fmt::format("{} steps are too few", c.steps), "steps", "use 1 or more");
  if (!(c.plasticity >= 0 && c.plasticity <= 1)) {
    return input_error(fmt::format("{} is not a plasticity", c.plasticity), "plasticity", "use a number from 0 to 1");
  }
  const auto length = diagonal();
  if (!length) return std::unexpected(length.error());
  const PlacedShape before = (*tool)->shape;
  const Placement& at = before.placement();
  const auto index = static_cast<std::size_t>(*tool - state.tools.data());
  const int total = c.steps * static_cast<int>(c.path.size());
  for (std::size_t k = 0; k < c.path.size(); ++k) {
    const Point given(c.path[k][0], c.path[k][1], c.path[k][2]);
    auto moved = before.moved(at.rotation, c.relative ? Point(at.position + *length * given) : given);
    if (!moved) return std::unexpected(moved.error().within(fmt::format("path[{}]", k)));
    state.tools[index].shape = std::move(*moved);
    if (auto done = run(c.steps, state.evolution, {}, static_cast<int>(k) * c.steps, total); !done) return done;
  }
  state.tools[index].shape = before;
  return yield(c.plasticity);
}

}  // namespace knead
