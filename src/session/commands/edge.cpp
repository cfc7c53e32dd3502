#include "edge.hpp"

#include <algorithm>

namespace knead {

template <>
Expected<void> Executor::execute(const EdgeCommand& c) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  // One by one, so that they can be freed so.
  const std::vector<SurfaceEdge> edges = edges_of(c.which);
  const int order = c.hold == EdgeCondition::position ? 0 : c.hold == EdgeCondition::clamped ? 1 : 2;
  for (int k : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    std::erase_if(s.constraints, [&](const KeptConstraint& kept) {
      const auto* edge = std::get_if<EdgeHold>(&kept.constraint);
      return edge != nullptr && std::ranges::find(edges, edge->edge) != edges.end();
    });
    if (c.hold == EdgeCondition::free) continue;
    for (SurfaceEdge edge : edges) s.constraints.push_back({EdgeHold{edge, order}, s.current});
  }
  return c.hold == EdgeCondition::free ? Expected<void>() : check_constraints();
}

}  // namespace knead
