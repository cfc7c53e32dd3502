#include "edge.hpp"

#include <algorithm>

namespace knead {

std::span<const Choice> choices(EdgeChoice) {
  static constexpr Choice list[] = {{"all", EdgeChoice::all},
                                    {"u0", EdgeChoice::u0, "where u is least"},
                                    {"u1", EdgeChoice::u1},
                                    {"v0", EdgeChoice::v0},
                                    {"v1", EdgeChoice::v1}};
  return list;
}

std::span<const Choice> choices(EdgeCondition) {
  static constexpr Choice list[] = {{"position", EdgeCondition::position},
                                    {"clamped", EdgeCondition::clamped, "with its tangent planes"},
                                    {"curvature", EdgeCondition::curvature, "with its curvatures too"},
                                    {"free", EdgeCondition::free, "no longer"}};
  return list;
}

void describe(EdgeCommand& c, Fields& fields) {
  fields.name("edge", "hold edges of the selected surfaces");
  fields.add("which", c.which);
  fields.add("hold", c.hold);
}

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
