#include "measure.hpp"

#include <algorithm>

#include "scene/places.hpp"
#include "session/acts/selection.hpp"
#include "session/acts/trimming.hpp"

namespace knead {

void describe(MeasureCommand& c, Fields& fields) {
  fields.name("measure", "report the final position of a surface point");
  fields.add("name", c.name, {.help = "what the report calls it"});
  fields.add("surface", c.surface, {.help = "its id", .fallback = "the first selected one"});
  fields.add(
      "at", c.at,
      {.help = "`[s, t]`: a point of the surface; or `\"middle\"`, the visible point farthest "
               "from all edges",
       .unit = Unit::fraction,
       .range = between(0, 1)});
  fields.add("middle", c.middle, {.help = "`true` is the same as `\"at\": \"middle\"`"});
}

Expected<void> execute(const MeasureCommand& c, Act& act) {
  int index = act.state.selected.value_or(0);
  if (c.surface) {
    const auto found = find_surface(act, *c.surface);
    if (!found) return std::unexpected(found.error());
    index = *found;
  } else if (auto chosen = selected(act); !chosen) {
    return std::unexpected(chosen.error());
  }
  SceneSurface& surface = act.state.surfaces[static_cast<std::size_t>(index)];
  const auto at = place_on(act, surface, {c.at, c.middle.value_or(false)});
  if (!at) return std::unexpected(at.error());
  if (auto u = parameters_at(*surface.current, *at); !u) return std::unexpected(u.error());
  Probe probe{"measurements", c.name, index, *at};
  const auto same = std::ranges::find_if(act.state.probes, [&](const Probe& p) {
    return p.list == probe.list && p.name == probe.name;
  });
  if (same != act.state.probes.end()) {
    *same = std::move(probe);
  } else {
    act.state.probes.push_back(std::move(probe));
  }
  return {};
}

}  // namespace knead
