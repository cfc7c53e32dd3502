#include "measure.hpp"

#include <algorithm>

#include "scene/places.hpp"

namespace knead {

void describe(MeasureCommand& c, Fields& fields) {
  fields.name("measure", "report the final position of a surface point");
  fields.add("name", c.name, {.help = "what the report calls it"});
  fields.add("surface", c.surface, {.help = "its id", .fallback = "the first selected one"});
  fields.add("at", c.at,
             {.help = "`[s, t]`: a point of the surface; or `\"middle\"`, the visible point farthest "
                      "from all edges",
              .unit = Unit::fraction});
  fields.add("middle", c.middle, {.help = "`true` is the same as `\"at\": \"middle\"`"});
}

template <>
Expected<void> Executor::execute(const MeasureCommand& c) {
  int index = state.selected.value_or(0);
  if (c.surface) {
    const auto found = find_surface(*c.surface);
    if (!found) return std::unexpected(found.error());
    index = *found;
  } else if (auto chosen = selected(); !chosen) {
    return std::unexpected(chosen.error());
  }
  SceneSurface& surface = state.surfaces[static_cast<std::size_t>(index)];
  const auto at = place_on(surface, {c.at, c.middle.value_or(false)});
  if (!at) return std::unexpected(at.error());
  if (auto u = parameters_at(*surface.current, *at); !u) return std::unexpected(u.error());
  Probe probe{"measurements", c.name, index, *at};
  const auto same =
      std::ranges::find_if(state.probes, [&](const Probe& p) { return p.list == probe.list && p.name == probe.name; });
  if (same != state.probes.end()) {
    *same = std::move(probe);
  } else {
    state.probes.push_back(std::move(probe));
  }
  return {};
}

}  // namespace knead
