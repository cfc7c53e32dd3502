#include "remove.hpp"

#include <algorithm>

namespace knead {

void describe(RemoveCommand& c, Fields& fields) {
  fields.name("remove", "remove a tool or force from the scene; a tool's plastic deformation remains");
  fields.add("tool", c.tool, {.help = "its name", .fallback = "the only one"});
}

template <>
Expected<void> Executor::execute(const RemoveCommand& c) {
  const auto force = std::ranges::find_if(
      state.forces, [&](const SceneForce& f) { return c.tool ? f.name == *c.tool : state.tools.empty(); });
  if (force != state.forces.end() && (c.tool || state.forces.size() == 1)) {
    state.forces.erase(force);
    return {};
  }
  auto tool = find_tool(c.tool);
  if (!tool) return std::unexpected(tool.error());
  const double plasticity = (*tool)->mode == ToolMode::imprint ? 1 : (*tool)->plasticity;
  state.tools.erase(state.tools.begin() + (*tool - state.tools.data()));
  if (plasticity > 0 && state.selected) return yield(plasticity);
  return {};
}

}  // namespace knead
