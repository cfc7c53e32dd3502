#include "data_holds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "data_moving.hpp"
#include "hold/held_cells.hpp"
#include "knead/brep/visible_region.hpp"
#include "knead/spline/extremum.hpp"
#include "scene/mask.hpp"
#include "scene/model/constraints.hpp"
#include "scene/places.hpp"
#include "scene/reshape.hpp"
#include "scene/trims.hpp"

namespace knead {
namespace {

using Line = std::vector<std::array<double, 2>>;

constexpr int parts = 64;  // of a whole side of the domain

Line line_between(const Surface& s, const Fractions& from, const Fractions& to) {
  Line result;
  for (int k = 0; k <= parts; ++k) {
    const double t = double(k) / parts;
    result.push_back(
        parameters_of(s, {std::lerp(from[0], to[0], t), std::lerp(from[1], to[1], t)}));
  }
  return result;
}

Line side_of(const Surface& s, SurfaceEdge edge) {
  Fractions from = {0, 0}, to = {1, 1};
  const auto across = static_cast<std::size_t>(edge_across(edge));
  from[across] = to[across] = edge_at_end(edge) ? 1 : 0;
  return line_between(s, from, to);
}

/// Appends the lines and points that one constraint keeps; part of the coordinates keeps no place.
struct Places {
  const Surface& shape;
  std::vector<Line>& to;

  void operator()(const EdgeHold& c) const {
    if (c.components == all_components) to.push_back(side_of(shape, c.edge));
  }
  void operator()(const PointPin& c) const {
    if (c.components == all_components) to.push_back({parameters_of(shape, {c.at[0], c.at[1]})});
  }
  void operator()(const Keep& c) const {
    if (c.u) to.push_back(line_between(shape, {*c.u, 0}, {*c.u, 1}));
    if (c.v) to.push_back(line_between(shape, {0, *c.v}, {1, *c.v}));
    for (std::size_t k = 1; k < c.curve.size(); ++k)
      to.push_back(line_between(shape, c.curve[k - 1], c.curve[k]));
  }
  // Of a frozen region the outline is found from the control points that it holds; symmetries keep
  // no place.
  void operator()(const Freeze&) const {}
  void operator()(const EdgeSymmetry&) const {}
  void operator()(const MirrorSymmetry&) const {}
  void operator()(const TrimHolds&) const {}
  void operator()(const TrimEdgeHold&) const {}
};

bool by_name(const KeptConstraint& kept) {
  const auto* edge = std::get_if<TrimEdgeHold>(&kept.constraint);
  return edge != nullptr && edge->order >= 0;
}

/// Whether data have to respect it: edges of faces that are held together go along.
bool counts(const KeptConstraint& kept) {
  return !std::holds_alternative<TrimHolds>(kept.constraint) &&
         (!std::holds_alternative<TrimEdgeHold>(kept.constraint) || by_name(kept));
}

std::vector<Line> places_of(const SceneSurface& s) {
  std::vector<Line> result;
  const Surface& shape = *s.current;
  if (s.hold_rows > 0) {
    for (const SurfaceEdge edge : edges_of(EdgeChoice::all)) result.push_back(side_of(shape, edge));
  }
  for (const auto& [i, j] : s.pins)
    result.push_back({{shape.knots(0).greville(i), shape.knots(1).greville(j)}});
  for (const KeptConstraint& kept : s.constraints)
    std::visit(Places{shape, result}, kept.constraint);
  if (!s.visible) return result;
  const auto orders = trim_orders(s.constraints, *s.visible);
  for (std::size_t e = 0; e < orders.size(); ++e) {
    if (orders[e] < 0) continue;
    Line line;
    for (const Eigen::Vector2d& corner : s.visible->edges[e].course)
      line.push_back(parameters_of(shape, corner));
    result.push_back(std::move(line));
  }
  return result;
}

/// The conditions on a finer net: those of the surface with all its shapes on it.
Expected<ConstraintList> conditions_on(SceneSurface s, const std::vector<FrozenRegion>& frozen,
                                       const Surface& net) {
  if (!same_basis(*s.current, net)) {
    const auto onto = [&](const Surface& shape) { return on_basis_of(shape, net); };
    if (auto changed = change_net(s, onto); !changed) return std::unexpected(changed.error());
  }
  ShapeInput<2> input;
  input.id = s.id;
  input.reference = s.current;
  input.mode = RestMode::none;  // what is smooth is not kept here
  input.hold_rows = s.hold_rows;
  input.pins = s.pins;
  input.constraints = s.constraints;
  input.visible = s.visible;
  input.masked = masked_points(s);
  std::vector<std::string> notes;
  auto list = constraints_of<2>(input, notes);
  for (std::size_t k = 0; list && k < frozen.size(); ++k) {
    const auto region = freeze_region(net, frozen[k].u, frozen[k].v, *list);
    if (!region) return std::unexpected(region.error());
  }
  return list;
}

/// Where nothing moves since control points are held by their numbers or a mask: on finer nets
/// other ones would be.
Expected<void> add_held_cells(const SceneSurface& s, std::vector<FrozenRegion>& to) {
  SceneSurface numbered = s;
  numbered.constraints.clear();
  const auto list = conditions_on(numbered, {}, *s.current);
  if (!list) return std::unexpected(list.error());
  const KnotVector &u = s.current->knots(0), &v = s.current->knots(1);
  for (const auto& [a, b] : held_cells(*s.current, list->held))
    to.push_back({{u[a], u[a + 1]}, {v[b], v[b + 1]}});
  return {};
}

/// The regions that are frozen, as they are on the present net: on a finer one they would be
/// smaller. They are taken from the constraints.
Expected<std::vector<FrozenRegion>> take_frozen(SceneSurface& s) {
  std::vector<FrozenRegion> result;
  for (const KeptConstraint& kept : s.constraints) {
    const auto* freeze = std::get_if<Freeze>(&kept.constraint);
    if (freeze == nullptr) continue;
    const auto region = region_at(*s.current, freeze->region);
    if (!region) return std::unexpected(region.error());
    ConstraintList list(s.current->size());
    const auto frozen = freeze_region(*s.current, (*region)[0], (*region)[1], list);
    if (!frozen) return std::unexpected(frozen.error());
    result.push_back(*frozen);
  }
  std::erase_if(s.constraints, [](const KeptConstraint& kept) {
    return std::holds_alternative<Freeze>(kept.constraint);
  });
  if (auto added = add_held_cells(s, result); !added) return std::unexpected(added.error());
  return result;
}

}  // namespace

bool holds_edge_by_name(const SceneSurface& s) {
  return std::ranges::any_of(s.constraints, by_name);
}

Expected<std::shared_ptr<const morph::SurfaceHolds>> data_holds(const SceneSurface& surface) {
  SceneSurface s = surface;
  std::erase_if(s.constraints, [](const KeptConstraint& kept) { return !counts(kept); });
  if (!holds_edge_by_name(s)) s.visible = nullptr;
  const auto masked = masked_points(s);
  if (s.constraints.empty() && s.pins.empty() && s.hold_rows == 0 &&
      std::ranges::find(masked, true) == masked.end())
    return nullptr;
  auto frozen = take_frozen(s);
  if (!frozen) return std::unexpected(frozen.error());
  // Where it is now, not where it was when that was asked for.
  s.opened = s.reference = s.rest = s.current;
  for (KeptConstraint& kept : s.constraints) kept.where = s.current;
  auto result = std::make_shared<morph::SurfaceHolds>();
  result->places = places_of(s);
  for (const KeptConstraint& kept : s.constraints) {
    if (const auto* mirror = std::get_if<MirrorSymmetry>(&kept.constraint))
      result->mirrored[static_cast<std::size_t>(mirror->direction)] = true;
  }
  result->conditions = [s = std::move(s), regions = *std::move(frozen)](const Surface& net) {
    return conditions_on(s, regions, net);
  };
  return result;
}

}  // namespace knead
