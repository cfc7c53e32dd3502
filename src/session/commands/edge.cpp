#include "edge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "../components.hpp"
#include "scene/trims.hpp"
#include "session/acts/following.hpp"
#include "session/acts/holding.hpp"
#include "session/acts/selection.hpp"
#include "session/acts/trimming.hpp"

namespace knead {
namespace {

/// Notes which faces stay behind when an edge is freed on a surface alone.
void note_opening(SessionState& state, const SceneSurface& s, const TrimEdge& edge) {
  for (std::size_t k = 0; k < edge.neighbours.size(); ++k) {
    const std::string& on = edge.supports[k];
    if (on.substr(0, on.find(' ')) == s.id) continue;
    state.notes.push_back(
        fmt::format("{}: the edge {} opens, as face {} on {} does not follow; use "
                    "\"hold\":\"follow\" to keep it closed",
                    s.id, edge.id, edge.neighbours[k], on));
  }
}

/// What was asked of one edge of faces before.
void forget(SceneSurface& s, const std::string& id) {
  std::erase_if(s.constraints, [&](const KeptConstraint& kept) {
    const auto* hold = std::get_if<TrimEdgeHold>(&kept.constraint);
    return hold != nullptr && hold->id == id;
  });
}

/// Holds one edge of the faces, or lets it follow or open, on those selected surfaces that have it.
Expected<void> hold_face_edge(Act& act, const EdgeCommand& c) {
  const bool follow = c.hold == EdgeCondition::follow;
  // The order of derivatives that are held is the condition's own number; beyond curvature nothing
  // is.
  const int order = c.hold > EdgeCondition::curvature ? -1 : static_cast<int>(c.hold);
  bool follows = false;
  std::string known;
  std::vector<int> changed;
  const std::vector<int> selection = act.state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(selection[k])];
    const auto region = visible(act, s);
    if (!region) return std::unexpected(region.error());
    for (const TrimEdge& edge : (*region)->edges) {
      known += (known.empty() ? "" : ", ") + edge.id;
      if (edge.id != *c.edge) continue;
      if (changed.empty() || changed.back() != static_cast<int>(k))
        changed.push_back(static_cast<int>(k));
      forget(s, edge.id);
      // Of a surface without faces: there is nothing to follow.
      const bool side = edge.neighbours.empty();
      if (c.hold == EdgeCondition::open) note_opening(act.state, s, edge);
      s.constraints.push_back({TrimEdgeHold{edge.id, order, follow && !side}, s.current});
      follows = follows || (follow && !side);
    }
  }
  if (!changed.empty()) {
    if (follows) {
      if (auto can = follow_edge(act, *c.edge); !can) return can;
      hold_likewise(act);
    }
    return check_constraints_on(act, changed);
  }
  return input_error(fmt::format("no face on the selected surfaces has an edge {}", *c.edge),
                     "which", known.empty() ? "no face lies on them" : "their edges are: " + known);
}

/// Where a surface without faces holds its sides as faces do their edges, what is asked of one
/// replaces that.
void hold_bare_sides(Act& act, SceneSurface& s, const std::vector<SurfaceEdge>& sides, bool free) {
  if (!holds_trims(s.constraints) || !visible(act, s)) return;  // what cannot be followed has faces
  for (const SurfaceEdge side : sides) {
    const std::string id = edge_name(side);
    if (std::ranges::find(s.visible->edges, id, &TrimEdge::id) == s.visible->edges.end()) continue;
    forget(s, id);
    if (free) s.constraints.push_back({TrimEdgeHold{id, -1}, s.current});
  }
}

}  // namespace

std::span<const Choice> choices(EdgeChoice) {
  static constexpr Choice list[] = {{"all", EdgeChoice::all, "every side"},
                                    {"u0", EdgeChoice::u0, "where u is least"},
                                    {"u1", EdgeChoice::u1, "where it is greatest"},
                                    {"v0", EdgeChoice::v0, "where v is least"},
                                    {"v1", EdgeChoice::v1, "where it is greatest"}};
  return list;
}

std::span<const Choice> choices(SideChoice) {
  static constexpr Choice list[] = {
      {"all", SideChoice::all, "every side"},
      {"u0", SideChoice::u0, "where u is least; of a curve, its beginning"},
      {"u1", SideChoice::u1, "where it is greatest; of a curve, its end"},
      {"v0", SideChoice::v0, "where v is least"},
      {"v1", SideChoice::v1, "where it is greatest"},
      {"w0", SideChoice::w0, "of a volume, where w is least"},
      {"w1", SideChoice::w1, "where it is greatest"}};
  return list;
}

std::span<const Choice> choices(EdgeCondition) {
  static constexpr Choice list[] = {
      {"position", EdgeCondition::position, "where it is"},
      {"tangent", EdgeCondition::tangent, "with its tangent planes"},
      {"curvature", EdgeCondition::curvature, "with its curvatures too"},
      {"follow", EdgeCondition::follow, "an edge of faces that all move together"},
      {"open", EdgeCondition::open, "not held; an edge of a face may part from its neighbours"}};
  return list;
}

void describe(EdgeCommand& c, Fields& fields) {
  fields.name("edge", "hold edges of the selected surfaces, ends of a curve, or sides of a volume");
  fields.add("which", c.which,
             {.help = "sides of the domain; or `\"#456\"`, an edge of a face, as by `edge`"});
  fields.add("hold", c.hold, {.help = "what of them stays as it is"});
  fields.add(
      "edge", c.edge,
      {.help =
           "`\"#456\"`: one edge of a face, as `knead info --faces` lists it, instead of `which`"});
  fields.add(
      "components", c.components,
      {.help =
           "the coordinates that this holds or frees, as `\"xz\"`; the others stay as they were",
       .fallback = "`\"xyz\"`"});
}

namespace {

SurfaceEdge side_of(const EdgeHold& hold) { return hold.edge; }
DomainSide side_of(const SideHold& hold) { return hold.side; }

/// Holds sides of a shape in these coordinates, or frees them, whatever was asked of them there
/// before.
template <class Hold, int D, class Side>
void hold_sides(SceneShape<D>& s, const std::vector<Side>& sides, EdgeCondition condition,
                const Components& components) {
  std::erase_if(s.constraints, [&](KeptConstraintOf<D>& kept) {
    auto* hold = std::get_if<Hold>(&kept.constraint);
    if (hold == nullptr || std::ranges::find(sides, side_of(*hold)) == sides.end()) return false;
    for (std::size_t d = 0; d < 3; ++d) hold->components[d] = hold->components[d] && !components[d];
    return std::ranges::none_of(hold->components, std::identity());
  });
  if (condition == EdgeCondition::open) return;
  const int order = condition == EdgeCondition::position  ? 0
                    : condition == EdgeCondition::tangent ? 1
                                                          : 2;
  // One by one, so that they can be freed one by one.
  for (const Side side : sides) s.constraints.push_back({Hold{side, order, components}, s.current});
}

/// The sides of a curve or a volume that a choice stands for.
std::vector<DomainSide> sides_of(SideChoice which, int directions) {
  std::vector<DomainSide> sides;
  for (int direction = 0; direction < directions; ++direction) {
    for (const bool upper : {false, true}) {
      const auto choice = static_cast<SideChoice>(static_cast<int>(SideChoice::u0) + 2 * direction +
                                                  (upper ? 1 : 0));
      if (which == SideChoice::all || which == choice) sides.push_back({direction, upper});
    }
  }
  return sides;
}

Expected<void> hold_body_sides(Act& act, const EdgeCommand& c) {
  if (c.edge) return of_surfaces(act, "faces", "give which, one of its sides");
  if (c.hold > EdgeCondition::open) return of_surfaces(act, "faces", R"(use "hold":"open")");
  const auto components = components_of(c.components);
  if (!components) return std::unexpected(components.error());
  const auto hold = [&]<int D>(SceneShape<D>& s) -> Expected<void> {
    const std::vector<DomainSide> sides = sides_of(c.which, D);
    if (sides.empty()) return input_error("a curve has no such end", "which", "use u0, u1 or all");
    hold_sides<SideHold>(s, sides, c.hold, *components);
    return c.hold == EdgeCondition::open ? Expected<void>() : check_constraints(act);
  };
  return std::visit(hold, *body(act));
}

}  // namespace

Expected<void> execute(const EdgeCommand& c, Act& act) {
  if (act.state.body) return hold_body_sides(act, c);
  if (auto surface = selected(act); !surface) return std::unexpected(surface.error());
  const auto components = components_of(c.components);
  if (!components) return std::unexpected(components.error());
  if (c.edge) {
    if (*components == all_components) return hold_face_edge(act, c);
    return input_error("edges of faces are held in all coordinates", "components",
                       "leave it out, or hold a boundary isocurve by which");
  }
  if (c.hold > EdgeCondition::open) {
    return input_error("boundary isocurves do not follow", "hold",
                       R"(name an edge of a face, "which":"#456", or use "open")");
  }
  if (c.which > SideChoice::v1) {
    return input_error("a surface has no such edge", "which", "use u0, u1, v0, v1 or all");
  }
  const std::vector<SurfaceEdge> edges = edges_of(edge_choice(c.which));
  for (SceneSurface& s : selected_surfaces(act.state)) {
    if (*components == all_components)
      hold_bare_sides(act, s, edges, c.hold == EdgeCondition::open);
    hold_sides<EdgeHold>(s, edges, c.hold, *components);
  }
  return c.hold == EdgeCondition::open ? Expected<void>() : check_constraints(act);
}

}  // namespace knead
