#include "remove.hpp"

#include <algorithm>

namespace knead {

void describe(RemoveCommand& c, Fields& fields) {
  fields.name("remove", "remove a tool, force or measurement from the scene; a tool's plastic deformation remains");
  fields.add("tool", c.tool, {.help = "its name", .fallback = "the only one"});
  fields.add("measurement", c.measurement, {.help = "the name of a measurement, to remove that instead of a tool"});
}

template <>
Expected<void> Executor::execute(const RemoveCommand& c) {
  if (c.measurement) {
    if (c.tool) return input_error("either a tool or a measurement is removed", "measurement", "use two commands");
    const auto gone = std::erase_if(state.probes, [&](const Probe& p) { return p.name == *c.measurement; });
    if (gone == 0) return input_error("there is no measurement \"" + *c.measurement + "\"", "measurement");
    return {};
  }
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
