#include "hold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "session/acts/holding.hpp"
#include "session/acts/selection.hpp"
#include "session/acts/trimming.hpp"

namespace knead {

std::span<const Choice> choices(HoldMode) {
  static constexpr Choice names[] = {
      {"rows", HoldMode::rows, "outer rows of control points"},
      {"position", HoldMode::position, "the edges of the faces"},
      {"tangent", HoldMode::tangent, "with their tangent planes"},
      {"curvature", HoldMode::curvature, "with their curvatures too"},
      {"open", HoldMode::open, "neither: the edges of the faces may open"}};
  return names;
}

void describe(HoldCommand& c, Fields& fields) {
  fields.name("hold", "hold the edges of faces, or the outer rows of control points on every side");
  fields.add("rows", c.rows,
             {.help = "number of rows in mode `rows`; 0 holds none", .range = at_least(0)});
  fields.add("mode", c.mode, {.help = "what is held", .fallback = "`\"rows\"`"});
  fields.add("all", c.all,
             {.help = "for every surface of the document, not only the selected ones"});
}

namespace {

bool holds_trims(HoldMode mode) { return mode != HoldMode::rows && mode != HoldMode::open; }

/// What is asked of all edges of faces on a surface.
void hold_edges(SceneSurface& s, HoldMode mode) {
  std::erase_if(s.constraints, [&](const KeptConstraint& kept) {
    const auto* edges = std::get_if<TrimHolds>(&kept.constraint);
    if (edges != nullptr)
      return mode != HoldMode::rows || edges->order >= 0;  // rows hold no edge that was freed
    return std::holds_alternative<TrimEdgeHold>(kept.constraint);
  });
  const int order =
      holds_trims(mode) ? static_cast<int>(mode) - static_cast<int>(HoldMode::position) : -1;
  if (mode != HoldMode::rows) s.constraints.push_back({TrimHolds{order}, s.current});
}

}  // namespace

Expected<void> execute(const HoldCommand& c, Act& act) {
  const bool all = c.all.value_or(false);
  const HoldMode mode = c.mode.value_or(HoldMode::rows);
  if (!all) {
    if (auto some = some_selected(act); !some) return some;
    if (act.state.body && holds_trims(mode))
      return of_surfaces(act, "faces", R"(use "mode":"rows")");
  }
  const auto hold = [&]<int D>(SceneShape<D>& s) -> Expected<void> {
    s.hold_rows = mode == HoldMode::rows ? c.rows : 0;
    if constexpr (D == 2) hold_edges(s, mode);
    return {};
  };
  if (!all) {
    if (auto status = each_selected(act, hold); !status) return status;
    return act.state.body      ? check_constraints(act)
           : holds_trims(mode) ? know_trims(act)
                               : Expected<void>();
  }
  for (std::size_t k = 0; k < act.state.surfaces.size(); ++k) {
    if (auto status = hold(act.state.surfaces[k]); !status) return status;
  }
  return {};
}

}  // namespace knead
