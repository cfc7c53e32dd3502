#include "scale.hpp"

#include <fmt/format.h>

#include "session/acts/selection.hpp"

namespace knead {

void describe(ScaleCommand& c, Fields& fields) {
  fields.name("scale", "scale a tool along its own axes");
  fields.add("tool", c.tool, {.help = "its name", .fallback = "the only tool"});
  fields.add("by", c.by,
             {.help = "`[a, b, c]`, factors", .range = above(0), .presence = Presence::required});
}

Expected<void> execute(const ScaleCommand& c, Act& act) {
  auto tool = find_tool(act, c.tool);
  if (!tool) return std::unexpected(tool.error());
  Placement at = (*tool)->shape.placement();
  for (std::size_t k = 0; k < 3; ++k) {
    at.scale[k] *= c.by[k];
  }
  auto scaled = PlacedShape::create((*tool)->shape.shape(), at);
  if (!scaled) return std::unexpected(scaled.error());
  (*tool)->shape = std::move(*scaled);
  return {};
}

}  // namespace knead
