#include "remove.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "session/acts/selection.hpp"
#include "session/acts/stepping.hpp"

namespace knead {

void describe(RemoveCommand& c, Fields& fields) {
  fields.name(
      "remove",
      "remove a tool, force or measurement from the scene; a tool's plastic deformation remains");
  fields.add("tool", c.tool, {.help = "its name", .fallback = "the only one"});
  fields.add("measurement", c.measurement,
             {.help = "the name of a measurement, to remove that instead of a tool"});
}

Expected<void> execute(const RemoveCommand& c, Act& act) {
  if (c.measurement) {
    if (c.tool)
      return input_error("either a tool or a measurement is removed", "measurement",
                         "use two commands");
    const auto gone =
        std::erase_if(act.state.probes, [&](const Probe& p) { return p.name == *c.measurement; });
    if (gone == 0) {
      std::vector<std::string> names;
      for (const Probe& p : act.state.probes) names.push_back(p.name);
      return input_error(
          fmt::format("there is no measurement \"{}\"", *c.measurement), "measurement",
          names.empty() ? std::string("make one first with the command measure")
                        : fmt::format("the measurements are: {}", fmt::join(names, ", ")));
    }
    return {};
  }
  const auto force = std::ranges::find_if(act.state.forces, [&](const SceneForce& f) {
    return c.tool ? f.name == *c.tool : act.state.tools.empty();
  });
  if (force != act.state.forces.end() && (c.tool || act.state.forces.size() == 1)) {
    act.state.forces.erase(force);
    return {};
  }
  auto tool = find_tool(act, c.tool);
  if (!tool) return std::unexpected(tool.error());
  const double plasticity = (*tool)->mode == ToolMode::imprint ? 1 : (*tool)->plasticity;
  act.state.tools.erase(act.state.tools.begin() + (*tool - act.state.tools.data()));
  if (plasticity > 0 && act.state.selected) return yield(act, plasticity);
  return {};
}

}  // namespace knead
