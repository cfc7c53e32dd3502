#include "trimming.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "following.hpp"
#include "holding.hpp"
#include "knead/base/error_code.hpp"
#include "knead/spline/evaluate.hpp"
#include "notes.hpp"
#include "refining.hpp"
#include "scene/trims.hpp"
#include "selection.hpp"
#include "session/command_fields.hpp"
#include "session/gestures/stroking.hpp"

namespace knead {
namespace {

// Of the size of a surface: folds nearer to a held edge than this are beside it.
constexpr double beside = 0.1;

/// The held edge of faces beside a place, in fractions; null where there is none. In space, on the
/// surface as opened.
const TrimEdge* held_beside(const SceneSurface& s, const Eigen::Vector2d& at) {
  const auto place = evaluate_point<2>(*s.opened, parameters_of(*s.opened, at));
  if (!place) return nullptr;
  const Points& net = s.opened->control_points();
  double least = beside * (net.colwise().maxCoeff() - net.colwise().minCoeff()).norm();
  const std::vector<int> orders = trim_orders(s.constraints, *s.visible);
  const TrimEdge* nearest = nullptr;
  for (std::size_t k = 0; k < orders.size(); ++k) {
    if (orders[k] < 0) continue;
    std::vector<bool> only(orders.size());
    only[k] = true;
    const double distance = s.visible->distance(*place, only);
    if (distance > least) continue;
    least = distance;
    nearest = &s.visible->edges[k];
  }
  return nearest;
}

Error fold_error(const SceneSurface& s, const Eigen::Vector2d& at) {
  const std::string place = fmt::format("{} at [{:.4f}, {:.4f}]", s.id, at.x(), at.y());
  if (const TrimEdge* edge = held_beside(s, at)) {
    const bool side = edge->neighbours.empty();  // where nothing could follow
    return Error(ErrorKind::numerical,
                 fmt::format("the step folds {} beside the edge {}, which is held, and was refused",
                             place, edge->id),
                 "step",
                 fmt::format(R"(press less deep or farther from it, )"
                             R"(or {}: {{"do":"edge","edge":"{}","hold":"{}"}})",
                             side ? "let it go" : "let the edge follow", edge->id,
                             side ? "open" : "follow"))
        .with({ErrorCode::step_folds_beside_edge,
               {{"surface", s.id}, {"edge", edge->id}, {"hold", side ? "open" : "follow"}}});
  }
  return Error(ErrorKind::numerical, fmt::format("the step folds {} and was refused", place),
               "step",
               "press less deep, go there in several steps with a larger lambda, or use a stiffer "
               "material")
      .with({ErrorCode::step_folds, {{"surface", s.id}}});
}

}  // namespace

bool any_held(const SceneSurface& s) {
  return s.visible && std::ranges::any_of(trim_orders(s.constraints, *s.visible),
                                          [](int order) { return order >= 0; });
}

Expected<const VisibleRegion*> visible(Act& act, SceneSurface& surface) {
  if (surface.visible) return surface.visible.get();
  std::shared_ptr<const VisibleRegion>& known = act.cache.faces.visible[surface.id];
  if (!known) {
    auto region = act.regions.of(surface.id);
    if (!region) {
      Error error = region.error();
      error.what = fmt::format("the edges of the faces on {} cannot be followed: {}", surface.id,
                               error.what);
      error.remedy =
          R"(hold something else: {"do":"hold","rows":2}, or {"do":"hold","mode":"open"})";
      return std::unexpected(
          std::move(error).with({ErrorCode::edges_unknown, {{"surface", surface.id}}}));
    }
    known = std::make_shared<const VisibleRegion>(std::move(*region));
  }
  surface.visible = known;
  return surface.visible.get();
}

Expected<void> know_trims(Act& act) {
  for (SceneSurface& s : selected_surfaces(act.state)) {
    const bool held = holds_trims(s.constraints);
    if (!held && !touches_visible(act.state)) continue;
    const auto region = visible(act, s);
    if (region) continue;
    if (held) return std::unexpected(region.error());
    const std::string note = region.error().what + "; tools touch all of the surface";
    note_once(act.state, note);
  }
  return {};
}

Expected<Fractions> place_on(Act& act, SceneSurface& surface, const SurfacePlace& place) {
  const bool strict = holds_trims(surface.constraints);
  const brep::SplineSurface* in_file =
      act.document.model() != nullptr ? act.document.model()->find_surface(surface.id) : nullptr;
  if (!place.middle && !strict && (in_file == nullptr || !in_file->trimmed)) return place.at;
  const auto region = visible(act, surface);
  if (!region) {
    if (!place.middle && !strict) return place.at;
    return std::unexpected(region.error());
  }
  if (place.middle) {
    const auto middle = visible_middle(*surface.current, **region);
    if (!middle) return std::unexpected(middle.error());
    return Fractions{middle->at.x(), middle->at.y()};
  }
  const Eigen::Vector2d at(place.at[0], place.at[1]);
  if (!(at.minCoeff() >= 0 && at.maxCoeff() <= 1) || (*region)->contains(at)) return place.at;
  const auto where = evaluate_point<2>(*surface.current, parameters_of(*surface.current, at));
  if (!where) return std::unexpected(where.error());
  const auto near = visible_near(*surface.current, **region, *where);
  if (!near) return std::unexpected(near.error());
  const std::string what = fmt::format(
      "[{:.6g}, {:.6g}] is not visible: the faces on {} leave it out", at.x(), at.y(), surface.id);
  const std::string remedy =
      fmt::format("the nearest visible point is [{:.4f}, {:.4f}], the middle \"middle\"",
                  near->at.x(), near->at.y());
  if (strict) return input_error(what, "at", remedy);
  act.state.notes.push_back(what + "; " + remedy);
  return place.at;
}

Expected<void> check_folds(const Scene& scene) {
  for (const SceneSurface& s : selected_surfaces(scene)) {
    if (!any_held(s) || s.current == s.opened) continue;
    const auto fold = first_fold(*s.opened, *s.current, *s.visible);
    if (!fold) return std::unexpected(fold.error());
    if (*fold) return std::unexpected(fold_error(s, **fold));
  }
  return {};
}

// Bisection for the largest share that folds nothing: six halvings give it to 1/64, and 90 % of
// that is taken, since at the very last share normals of the fold are nearly perpendicular. A share
// of less than a tenth would hardly be what was asked for: that is refused.
Expected<std::string> keep_unfolded(const Scene& scene, std::string_view what, double whole,
                                    const std::function<Expected<void>(double)>& shows) {
  constexpr int halvings = 6;
  constexpr double safe = 0.9, least = 0.1;
  const auto sound = check_folds(scene);
  if (sound) return std::string();
  double flat = 0, folded = whole;
  for (int k = 0; k < halvings; ++k) {
    const double middle = 0.5 * (flat + folded);
    if (auto shown = shows(middle); !shown) return std::unexpected(shown.error());
    (check_folds(scene) ? flat : folded) = middle;
  }
  if (safe * flat < least * whole) return std::unexpected(sound.error());
  if (auto shown = shows(safe * flat); !shown) return std::unexpected(shown.error());
  if (auto still = check_folds(scene); !still) return std::unexpected(still.error());
  return fmt::format("the {} keeps {:.0f} % of its depth, as more would fold a face", what,
                     100 * safe * flat);
}

// An equilibrium that folds is refused rather than shortened: a share of it is no equilibrium.
Expected<std::string> keep_step_unfolded(Scene& scene,
                                         std::span<const std::shared_ptr<const Surface>> from,
                                         bool first, const EvolutionPolicy& evolution) {
  const auto sound = check_folds(scene);
  if (sound) return std::string();
  if (evolution.mode == Evolution::stationary) return std::unexpected(sound.error());
  const Scene whole = scene;
  const auto shows = [&](double share) -> Expected<void> {
    for (const int k : scene.selection()) {
      const auto at = static_cast<std::size_t>(k);
      const SceneSurface& moved = whole.surfaces[at];
      SceneSurface& s = scene.surfaces[at];
      auto nearer = part_of_way(*from[at], moved.current, share);
      if (!nearer) return std::unexpected(nearer.error());
      if (*nearer == moved.current) continue;
      s.current = std::move(*nearer);
      if (moved.rest == moved.current) s.rest = s.current;
      s.velocity = share * moved.velocity;
    }
    return {};
  };
  auto note = keep_unfolded(scene, "step", 1, shows);
  if (note || first) return note;
  if (auto back = shows(0); !back) return std::unexpected(back.error());
  return "the step is not made, as it would fold a face";
}

}  // namespace knead
