#include "hold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace knead {

std::span<const Choice> choices(HoldMode) {
  static constexpr Choice names[] = {{"rows", HoldMode::rows},
                                     {"trim", HoldMode::trim, "the edges of the faces"},
                                     {"trim-g1", HoldMode::trim_g1, "with their tangent planes"},
                                     {"trim-g2", HoldMode::trim_g2, "with their curvatures too"},
                                     {"free", HoldMode::free, "neither: the edges of the faces may open"}};
  return names;
}

void describe(HoldCommand& c, Fields& fields) {
  fields.name("hold", "hold the edges of faces, or the outer rows of control points on every side");
  fields.add("rows", c.rows, {.help = "number of rows in mode `rows`; 0 holds none"});
  fields.add("mode", c.mode, {.fallback = "`\"rows\"`"});
  fields.add("all", c.all, {.help = "for every surface of the document, not only the selected ones"});
}

template <>
Expected<void> Executor::execute(const HoldCommand& c) {
  const bool all = c.all.value_or(false);
  const HoldMode mode = c.mode.value_or(HoldMode::rows);
  if (!all) {
    if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  }
  if (c.rows < 0) return input_error(fmt::format("{} rows cannot be held", c.rows), "rows", "use 0 or more");
  std::vector<int> surfaces = state.selection();
  if (all) {
    surfaces.resize(state.surfaces.size());
    std::iota(surfaces.begin(), surfaces.end(), 0);
  }
  const bool trims = mode != HoldMode::rows && mode != HoldMode::free;
  for (int k : surfaces) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    s.hold_rows = mode == HoldMode::rows ? c.rows : 0;
    std::erase_if(s.constraints, [&](const KeptConstraint& kept) {
      const auto* edges = std::get_if<TrimHolds>(&kept.constraint);
      if (edges != nullptr) return mode != HoldMode::rows || edges->order >= 0;  // rows hold no edge that was freed
      return std::holds_alternative<TrimEdgeHold>(kept.constraint);
    });
    const int order = trims ? static_cast<int>(mode) - static_cast<int>(HoldMode::trim) : -1;
    if (mode != HoldMode::rows) s.constraints.push_back({TrimHolds{order}, s.current});
  }
  return trims && !all ? know_trims() : Expected<void>();
}

}  // namespace knead
