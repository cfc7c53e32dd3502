#include "holding.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <ranges>

#include "following.hpp"
#include "knead/base/error_code.hpp"
#include "scene/trims.hpp"
#include "selection.hpp"
#include "trimming.hpp"

namespace knead {
namespace {

constexpr std::size_t most_listed = 8;

std::string place_of(const MovedTrim& edge) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", edge.place.x(), edge.place.y(), edge.place.z());
}

/// One command that lets an edge follow, for each.
std::string all_follow(const std::vector<std::string>& ids) {
  std::string text;
  for (std::size_t k = 0; k < std::min(ids.size(), most_listed); ++k) {
    text +=
        fmt::format(R"({}{{"do":"edge","edge":"{}","hold":"follow"}})", k == 0 ? "" : ", ", ids[k]);
  }
  return ids.size() > most_listed ? text + ", …" : text;
}

/// \param worst moved farthest, of the surface with this id
Error opened_edge(const MovedTrim& worst, const std::string& surface,
                  const std::vector<std::string>& ids) {
  std::string between;
  if (worst.neighbours.size() > 1)
    between = fmt::format(" between the faces {}", fmt::join(worst.neighbours, " and "));
  std::string what;
  if (worst.distance > 0) {
    what = fmt::format("the edge {} on {}{} is held, and would open by {:.3g} at {}", worst.id,
                       surface, between, worst.distance, place_of(worst));
  } else {
    what = fmt::format(
        "the tangent planes along the edge {} on {}{} are held, and would turn by {:.3g} degrees "
        "at {}",
        worst.id, surface, between, worst.turn * 180 / std::numbers::pi, place_of(worst));
  }
  if (ids.size() > 1)
    what += fmt::format("; {} other edge{} likewise", ids.size() - 1, ids.size() == 2 ? "" : "s");
  const bool opens = worst.distance > 0;
  return Error(ErrorKind::numerical, what + "; this was refused", "edge",
               fmt::format(R"(move less of the surface, or let what moves follow: {}; )"
                           R"({{"do":"hold","mode":"open"}} lets it open)",
                           all_follow(ids)))
      .with({opens ? ErrorCode::edge_would_open : ErrorCode::edge_would_turn,
             {{"edge", worst.id},
              {"surface", surface},
              {opens ? "distance" : "angle",
               opens ? worst.distance : worst.turn * 180 / std::numbers::pi},
              {"edges", ids}}});
}

}  // namespace

namespace {

/// The order at which the edges of faces on a surface are held, all alike; none: nothing is said of
/// them all.
std::optional<int> order_of_all(const SceneSurface& s) {
  std::optional<int> order;
  for (const KeptConstraint& kept : s.constraints) {
    if (const auto* trims = std::get_if<TrimHolds>(&kept.constraint)) order = trims->order;
  }
  return order;
}

/// Whether nothing is said of what holds a surface, but of edges that follow.
bool nothing_said(const SceneSurface& s) {
  return s.hold_rows == 0 && s.pins.empty() &&
         std::ranges::all_of(s.constraints, [](const KeptConstraint& kept) {
           const auto* edge = std::get_if<TrimEdgeHold>(&kept.constraint);
           return edge != nullptr && edge->follow;
         });
}

}  // namespace

Expected<void> add_constraint(Act& act, const Constraint& constraint) {
  if (auto surface = selected(act); !surface) return std::unexpected(surface.error());
  for (SceneSurface& s : selected_surfaces(act.state)) {
    s.constraints.push_back({constraint, s.current});
  }
  return check_constraints(act);
}

// Whether conditions contradict one another shows in their elimination alone. Of curves and
// volumes, which are small, the whole model is made.
Expected<void> check_constraints(Act& act) {
  if (act.state.body) {
    const auto check = [&]<int D>(const SceneShape<D>&) -> Expected<void> {
      const auto model = make_model(model_input<D>(act.state, trial_evolution()));
      return model ? Expected<void>() : std::unexpected(model.error());
    };
    return std::visit(check, *body(act));
  }
  if (auto known = know_trims(act); !known) return known;
  if (auto known = know_followed(act); !known) return known;
  return act.cache.conditions.check(model_input(act.state, trial_evolution()));
}

Expected<void> check_constraints_on(Act& act, std::span<const int> changed) {
  if (auto known = know_trims(act); !known) return known;
  const ModelInput input = model_input(act.state, trial_evolution());
  return check_conditions(asks_for_motion(input) ? input : part_of(input, changed));
}

void hold_likewise(Act& act) {
  std::optional<int> order;
  for (const int k : act.state.selection()) {
    const auto rows = order_of_all(std::as_const(act.state.surfaces)[static_cast<std::size_t>(k)]);
    if (!order && rows.value_or(-1) >= 0) order = rows;
  }
  if (!order) return;
  for (const int k : act.state.selection()) {
    if (!nothing_said(std::as_const(act.state.surfaces)[static_cast<std::size_t>(k)])) continue;
    SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(k)];
    const auto region = visible(act, s);
    if (!region) {
      act.state.notes.push_back(region.error().what + "; they are not held, and may open");
      continue;
    }
    if ((*region)->edges.empty()) continue;
    s.constraints.insert(s.constraints.begin(), {TrimHolds{*order}, s.current});
  }
}

// A step holds edges by leaving control points out of the unknowns; commands that place control
// points do not, and are measured. The error lists all edges, and names the one that moved
// farthest.
Expected<void> check_held_edges(Act& act, const Scene& before) {
  std::vector<std::string> ids;
  MovedTrim worst;
  std::string surface;
  for (std::size_t k = 0; k < act.state.surfaces.size(); ++k) {
    const SceneSurface& present = std::as_const(act.state.surfaces)[k];
    const SceneSurface* const was = find_surface(before, present.id, k);
    if (was == nullptr || was->current == present.current || !holds_trims(present.constraints))
      continue;
    SceneSurface& s = act.state.surfaces[k];
    const auto region = visible(act, s);
    if (!region) return std::unexpected(region.error());
    std::vector<int> orders = trim_orders(s.constraints, **region);
    for (std::size_t e = 0; e < orders.size(); ++e) {
      if ((*region)->edges[e].neighbours.empty())
        orders[e] = -1;  // a side where no face would part from another
    }
    const auto moved = moved_trims(*was->current, *s.current, orders, **region);
    if (!moved) return std::unexpected(moved.error());
    for (const MovedTrim& edge : *moved) {
      const bool more =
          edge.distance != worst.distance ? edge.distance > worst.distance : edge.turn > worst.turn;
      if (ids.empty() || more) {
        worst = edge;
        surface = s.id;
      }
      if (std::ranges::find(ids, edge.id) == ids.end()) ids.push_back(edge.id);
    }
  }
  if (ids.empty()) return {};
  return std::unexpected(opened_edge(worst, surface, ids));
}

Expected<std::vector<PartedEdge>> parted_edges(const Document& document,
                                               const SessionState& state) {
  const brep::Model* const model = document.model();
  std::vector<std::string> moved;
  for (std::size_t k = 0; model != nullptr && k < state.surfaces.size(); ++k) {
    const SceneSurface& s = state.surfaces[k];
    if (model->find_surface(s.id) != nullptr && moved_control_points(s) > 0) moved.push_back(s.id);
  }
  if (moved.empty()) return std::vector<PartedEdge>();
  const auto contacts = edge_contacts(*model, moved);
  if (!contacts) return std::unexpected(contacts.error());
  return parted_edges(state, *contacts);
}

Expected<std::vector<PartedEdge>> Session::parted_edges() const {
  return knead::parted_edges(document(), state());
}

bool holds_edges(const Scene& scene) {
  return std::ranges::any_of(scene.selection(), [&](int k) {
    return holds_trims(scene.surfaces[static_cast<std::size_t>(k)].constraints);
  });
}

Error all_held(const Scene& scene, const std::string& tool) {
  std::string by, remedy;
  Diagnostic diagnostic{ErrorCode::nothing_free, {{"tool", tool}}};
  const auto say = [&](ErrorCode code, const NamedValue& surface, const NamedValue& more) {
    if (code > diagnostic.code) diagnostic = {code, {{"tool", tool}, surface, more}};
  };
  for (const SceneSurface& s : selected_surfaces(scene)) {
    const auto [m, n] = s.current->net();
    std::string what;
    if (s.hold_rows > 0) {
      what = fmt::format("hold of {} rows on its net of {} x {}", s.hold_rows, m, n);
      remedy =
          R"(hold the edges of the face instead, {"do":"hold","mode":"position"}, or fewer rows, )"
          R"(or refine first)";
      say(ErrorCode::nothing_free_in_rows, {"surface", s.id},
          {"rows", static_cast<double>(s.hold_rows)});
    } else if (holds_trims(s.constraints)) {
      what = fmt::format("hold of the edges of its faces on its net of {} x {}", m, n);
      remedy = scene.permission == RefinePermission::never
                   ? R"(permit refining, {"do":"refine","permission":"trims"}, or free an edge)"
                   : "press farther from the edges, or free the one that is near";
      say(ErrorCode::nothing_free_at_edges, {"surface", s.id},
          {"permission", scene.permission == RefinePermission::never ? "never" : "trims"});
    } else {
      what = "pins, frozen regions and held lines";
      remedy = "release some of it";
    }
    by += fmt::format("{}{}: {}", by.empty() ? "" : "; ", s.id, what);
  }
  return Error(ErrorKind::numerical,
               fmt::format("nothing is free to move under the tool {} ({})", tool, by), "step",
               remedy + R"(; or go on regardless with "allow":"held")")
      .with(std::move(diagnostic));
}

}  // namespace knead
