#include "through_walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <type_traits>
#include <variant>

#include "act.hpp"
#include "brep/trim_loops.hpp"
#include "knead/base/error_code.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"
#include "notes.hpp"
#include "refining.hpp"
#include "scene/display.hpp"
#include "scene/model/model_walls.hpp"
#include "session/commands.hpp"
#include "session/gestures/stroking.hpp"
#include "spline/onto_net.hpp"
#include "trimming.hpp"

namespace knead {
namespace {

constexpr double near_share = 1e-6;  // of the size of a model

bool same_points(const Surface& a, const Surface& b) {
  const Points &p = a.control_points(), &q = b.control_points();
  return p.rows() == q.rows() && p == q;
}

/// The way of a surface, both ends on the present net; null where there is no such net.
/// Two shapes are a motion only on one net, where each control point has one straight way.
Motion motion_of(const std::shared_ptr<const Surface>& from,
                 const std::shared_ptr<const Surface>& to) {
  if (from == to || !from) return {to, to};
  if (same_basis(*from, *to)) return {same_points(*from, *to) ? to : from, to};
  auto raised = onto_net(*from, *to);
  if (!raised || !same_basis(*raised, *to)) return {};
  return {std::make_shared<const Surface>(std::move(*raised)), to};
}

std::shared_ptr<const Surroundings> surroundings_of(const Document& document) {
  const brep::Model* const model = document.model();
  if (model == nullptr) return nullptr;
  const auto trims = trim_loops(*model);
  return surroundings(
      *model, shown_regions(trims ? std::span(trims->surfaces) : std::span<const SurfaceTrim>()));
}

}  // namespace

std::span<const Choice> choices(ThroughAllowance) {
  static constexpr Choice names[] = {
      {"through", ThroughAllowance::through, "no note if a face comes through another"},
      {"nothing", ThroughAllowance::nothing, "it stops where a face would come through another"}};
  return names;
}

void describe_allowance(std::optional<ThroughAllowance>& allow, Fields& fields) {
  fields.add("allow", allow,
             {.help = "where it comes to another face",
              .fallback = "a note if a face comes through another"});
}

std::optional<Through> through_of(const Command& command, bool stops) {
  return std::visit(
      [stops]<class C>(const C& fields) -> std::optional<Through> {
        if constexpr (requires { fields.allow; }) {
          using Allowance = std::remove_cvref_t<decltype(*fields.allow)>;
          if (fields.allow == Allowance::nothing) return Through::stop;
          if (fields.allow == Allowance::through) return Through::allow;
          if constexpr (std::is_same_v<Allowance, StepAllowance>) {
            if (fields.allow == Allowance::all) return Through::allow;
            if (fields.allow == Allowance::held) return Through::note;
          }
          return stops ? Through::stop : Through::note;
        } else {
          return std::nullopt;
        }
      },
      command.any().fields);
}

Command that_stops(const Command& command) {
  CommandVariant all = command.any().fields;
  std::visit(
      [](auto& fields) {
        if constexpr (requires { fields.allow; }) {
          fields.allow = std::remove_cvref_t<decltype(*fields.allow)>::nothing;
        }
      },
      all);
  return make_command(std::move(all));
}

namespace {

ModelWalls& known_walls(Act& act) {
  if (!act.cache.faces.walls)
    act.cache.faces.walls = std::make_shared<ModelWalls>(surroundings_of(act.document));
  return *act.cache.faces.walls;
}

/// "the face #45 on #20", by what is known of its edges.
std::string face_on(Act& act, const std::string& surface) {
  std::set<std::string> ids;
  const auto found =
      std::ranges::find(std::as_const(act.state.surfaces), surface, &SceneSurface::id);
  SceneSurface& s =
      act.state
          .surfaces[static_cast<std::size_t>(found - std::as_const(act.state.surfaces).begin())];
  if (const auto region = visible(act, s)) {
    for (const TrimEdge& edge : (*region)->edges) {
      for (std::size_t k = 0; k < std::min(edge.supports.size(), edge.neighbours.size()); ++k) {
        if (edge.supports[k].substr(0, edge.supports[k].find(' ')) == surface)
          ids.insert(edge.neighbours[k]);
      }
    }
  }
  return ids.size() == 1 ? fmt::format("the face {} on {}", *ids.begin(), surface)
                         : "the face on " + surface;
}

/// Of each surface the shape from which the motion of this command is measured; null: there was
/// none.
std::vector<std::shared_ptr<const Surface>> shapes_before(const Scene& scene, const Scene& before) {
  std::vector<std::shared_ptr<const Surface>> shapes;
  for (std::size_t k = 0; k < scene.surfaces.size(); ++k) {
    const std::string& id = std::as_const(scene.surfaces)[k].id;
    const SceneSurface* const was = find_surface(before, id, k);
    shapes.push_back(was == nullptr ? nullptr : was->current);
  }
  const std::span<const OpenStroke::Before> open = before_gesture(scene);
  const std::vector<int> selection = scene.selection();
  for (std::size_t k = 0; k < std::min(open.size(), selection.size()); ++k) {
    shapes[static_cast<std::size_t>(selection[k])] = open[k].current;
  }
  return shapes;
}

/// The rest shape from before an open brush, which moves it; else the present one.
std::shared_ptr<const Surface> rest_before(const Scene& scene, int surface) {
  const std::vector<int> selection = scene.selection();
  const auto found = std::ranges::find(selection, surface);
  if (!scene.brush || found == selection.end())
    return scene.surfaces[static_cast<std::size_t>(surface)].rest;
  return scene.brush->before[static_cast<std::size_t>(found - selection.begin())].rest;
}

/// All that moved from there, made smaller alike: what is held is linear in displacements.
Expected<void> stop_at_face(Act& act, std::span<const WallMotion> motions, double share) {
  if (act.state.stroke) return Stroke(act).keep_share(share);
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const Motion& motion = motions[k].motion;
    if (!motion.from || !motion.moves()) continue;
    SceneSurface& s = act.state.surfaces[k];
    const bool same = s.rest == s.current;
    auto current = part_of_way(*motion.from, s.current, share);
    if (!current) return std::unexpected(current.error());
    const Motion of_rest =
        same ? motion : motion_of(rest_before(act.state, static_cast<int>(k)), s.rest);
    auto rest = same           ? current
                : of_rest.from ? part_of_way(*of_rest.from, s.rest, share)
                               : Expected<std::shared_ptr<const Surface>>(s.rest);
    if (!rest) return std::unexpected(rest.error());
    s.current = std::move(*current);
    s.rest = std::move(*rest);
    s.velocity.resize(0, 3);
  }
  return check_folds(act.state);
}

}  // namespace

// A command of n steps that may stop is compared n times, one that only notes is compared once,
// over all of its way. That way is not the steps' own path: what went through a face and came back
// is not noted.
Expected<void> FaceMeeting::after_step(Act& act,
                                       std::span<const std::shared_ptr<const Surface>> before) {
  if (through_ != Through::stop) return {};
  each_step_ = true;
  return meet(act, before);
}

Expected<void> FaceMeeting::at_end(Act& act, const Scene& before) {
  if (through_ == Through::allow || each_step_) return {};
  return meet(act, shapes_before(act.state, before));
}

// Finds the first contact of the whole scene, moved from `before` to now; if the command stops,
// everything is led back to the share of the motion at which twice the tolerance is left
// (`FaceContact::room`).
Expected<void> FaceMeeting::meet(Act& act, std::span<const std::shared_ptr<const Surface>> before) {
  std::vector<WallMotion> motions;
  bool any = false;
  double tolerance = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const SceneSurface& s = std::as_const(act.state.surfaces)[k];
    motions.push_back({s.id, motion_of(before[k], s.current), s.opened, s.visible, 0});
    any = any || motions.back().motion.moves();
    if (s.visible) tolerance = std::max(tolerance, s.visible->uncertainty);
  }
  if (!any) return {};
  ModelWalls& walls = known_walls(act);
  if (const Surroundings* const around = walls.around()) {
    for (WallMotion& wall : motions) {
      const auto shown = around->shown.find(wall.id);
      if (wall.visible == nullptr && shown != around->shown.end())
        wall.visible = shown->second.visible;
      wall.part = around->part_of(wall.id);
    }
  }
  tolerance = std::max(tolerance, near_share * walls.diagonal(motions));
  const auto contact = walls.first_contact(motions, tolerance);
  if (!contact) return {};
  const SceneSurface& s = std::as_const(act.state.surfaces)[contact->surface];
  const Surface& home = s.rest != s.current ? *s.rest : *motions[contact->surface].motion.from;
  const auto begin = evaluate_point<2>(home, contact->at);
  const double deep = begin ? (contact->place - *begin).norm() : 0;
  const std::string to =
      contact->met == contact->surface
          ? "its own other side"
          : (contact->met ? face_on(act, motions[*contact->met].id) : "the face " + contact->face);
  const Point& at = contact->place;
  const std::string place =
      fmt::format("{} at ({:.6g}, {:.6g}, {:.6g}), {:.4g} deep", to, at.x(), at.y(), at.z(), deep);
  const auto read = [&](ErrorCode code) -> Diagnostic {
    return {code,
            {{"surface", s.id},
             {"other", to},
             {"x", at.x()},
             {"y", at.y()},
             {"z", at.z()},
             {"depth", deep}}};
  };
  if (through_ == Through::note) {
    note_last(act.state, "through another face",
              fmt::format(": {} comes to {}, and goes on; press less deep, or say "
                          "\"allow\":\"through\"",
                          s.id, place),
              read(ErrorCode::through_face));
    return {};
  }
  note_last(act.state, "stopped at another face",
            fmt::format(": {} would come through {}; \"allow\":\"through\" lets it", s.id, place),
            read(ErrorCode::stopped_at_face));
  stopped_ = true;
  return stop_at_face(act, motions, contact->room);
}

}  // namespace knead
