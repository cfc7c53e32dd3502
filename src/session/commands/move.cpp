#include "move.hpp"

#include "session/acts/selection.hpp"

namespace knead {

void describe(MoveCommand& c, Fields& fields) {
  fields.name("move", "move a tool");
  fields.add("tool", c.tool, {.help = "its name", .fallback = "the only tool"});
  fields.add("by", c.by,
             {.help = "`[dx, dy, dz]`", .unit = Unit::length, .presence = Presence::required});
  fields.add("relative", c.relative, {.help = "`by` is in fractions of the diagonal"});
}

Expected<void> execute(const MoveCommand& c, Act& act) {
  auto tool = find_tool(act, c.tool);
  if (!tool) return std::unexpected(tool.error());
  double unit = 1;
  if (c.relative) {
    const auto length = diagonal(act);
    if (!length) return std::unexpected(length.error());
    unit = *length;
  }
  const Placement& at = (*tool)->shape.placement();
  auto moved =
      (*tool)->shape.moved(at.rotation, at.position + unit * Point(c.by[0], c.by[1], c.by[2]));
  if (!moved) return std::unexpected(moved.error());
  (*tool)->shape = std::move(*moved);
  return {};
}

}  // namespace knead
