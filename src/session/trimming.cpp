#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "command_fields.hpp"
#include "knead/base/error_code.hpp"
#include "knead/scene/trims.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

bool any_held(const SceneSurface& s) {
  return s.visible && std::ranges::any_of(trim_orders(s.constraints, *s.visible), [](int order) { return order >= 0; });
}

constexpr double beside = 0.1;  // of the size of a surface: folds nearer to a held edge than this are beside it

/// The held edge of faces beside a place, in fractions; null where there is none. In space, on the surface as opened.
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
                 fmt::format("the step folds {} beside the edge {}, which is held, and was refused", place, edge->id),
                 "step",
                 fmt::format(R"(press less deep or farther from it, or {}: {{"do":"edge","edge":"{}","hold":"{}"}})",
                             side ? "let it go" : "let the edge follow", edge->id, side ? "free" : "follow"))
        .with({ErrorCode::step_folds_beside_edge,
               {{"surface", s.id}, {"edge", edge->id}, {"hold", side ? "free" : "follow"}}});
  }
  return Error(ErrorKind::numerical, fmt::format("the step folds {} and was refused", place), "step",
               "press less deep, go there in several steps with a larger lambda, or use a stiffer material")
      .with({ErrorCode::step_folds, {{"surface", s.id}}});
}

}  // namespace

const Surface* Executor::document_surface(const SceneSurface& surface) const {
  for (const DocumentSurface& s : document.surfaces()) {
    if (s.id == surface.id) return s.surface.get();
  }
  return surface.opened.get();
}

Expected<const VisibleRegion*> Executor::visible(SceneSurface& surface) {
  if (surface.visible) return surface.visible.get();
  std::shared_ptr<const VisibleRegion>& known = faces.visible[surface.id];
  if (!known) {
    auto region = regions.of(surface.id);
    if (!region) {
      Error error = region.error();
      error.what = fmt::format("the edges of the faces on {} cannot be followed: {}", surface.id, error.what);
      error.remedy = R"(hold something else: {"do":"hold","rows":2}, or {"do":"hold","mode":"free"})";
      return std::unexpected(std::move(error).with({ErrorCode::edges_unknown, {{"surface", surface.id}}}));
    }
    known = std::make_shared<const VisibleRegion>(std::move(*region));
  }
  surface.visible = known;
  return surface.visible.get();
}

Expected<void> Executor::know_trims() {
  for (int k : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    const bool held = holds_trims(s.constraints);
    if (!held && !touches_visible(state)) continue;
    const auto region = visible(s);
    if (region) continue;
    if (held) return std::unexpected(region.error());
    const std::string note = region.error().what + "; tools touch all of the surface";
    if (std::ranges::find(state.notes, note) == state.notes.end()) state.notes.push_back(note);
  }
  return {};
}

Expected<Fractions> Executor::place_on(SceneSurface& surface, const SurfacePlace& place) {
  const bool strict = holds_trims(surface.constraints);
  const brep::SplineSurface* in_file =
      document.model() != nullptr ? document.model()->find_surface(surface.id) : nullptr;
  if (!place.middle && !strict && (in_file == nullptr || !in_file->trimmed)) return place.at;
  const auto region = visible(surface);
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
  const std::string what =
      fmt::format("[{:.6g}, {:.6g}] is not visible: the faces on {} leave it out", at.x(), at.y(), surface.id);
  const std::string remedy =
      fmt::format("the nearest visible point is [{:.4f}, {:.4f}], the middle \"middle\"", near->at.x(), near->at.y());
  if (strict) return input_error(what, "at", remedy);
  state.notes.push_back(what + "; " + remedy);
  return place.at;
}

Expected<void> Executor::refine_round(SceneSurface& s, const TrimContact& contact, double size) {
  if (state.permission == RefinePermission::never || !s.pins.empty()) return {};
  const auto refinement = trim_refinement(*s.reference, contact.at, contact.distance, std::isfinite(size) ? size : 0,
                                          trim_refinement_cap(*document_surface(s)));
  if (!refinement) return std::unexpected(refinement.error());
  if (refinement->capped) {
    state.notes.push_back(
        fmt::format("{}: the net between tool and held edges stays coarser than it should be, as it is limited to {} "
                    "control points; "
                    "refine it where it matters with {{\"do\":\"refine\"}}",
                    s.id, trim_refinement_cap(*document_surface(s))));
  }
  if (refinement->empty()) return {};
  return change_net(s, [&](const Surface& shape) { return refinement->apply(shape); });
}

Expected<void> Executor::refine_trims() {
  if (auto known = know_trims(); !known) return known;
  for (int k : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    if (!any_held(s)) continue;
    for (const Tool& tool : state.tools) {
      const auto contact = trim_contact(s, tool);
      if (!contact) return std::unexpected(contact.error());
      if (!*contact) continue;
      if (auto done = refine_round(s, **contact, tool.shape.size()); !done) return done;
      if (auto done = refine_followed(s, **contact, tool.shape.size()); !done) return done;
    }
  }
  return {};
}

Expected<void> Executor::refine_at_trims(SceneSurface& surface, const Fractions& at, double size) {
  if (auto known = know_trims(); !known) return known;
  if (!any_held(surface)) return {};
  TrimContact contact{parameters_of(*surface.current, {at[0], at[1]}), 0};
  const auto place = evaluate_point<2>(*surface.opened, contact.at);
  if (!place) return std::unexpected(place.error());
  std::vector<bool> held;
  for (const int order : trim_orders(surface.constraints, *surface.visible)) held.push_back(order >= 0);
  contact.distance = surface.visible->distance(*place, held);
  if (auto done = refine_round(surface, contact, size); !done) return done;
  return refine_followed(surface, contact, size);
}

Expected<void> Executor::check_folds() {
  for (int k : state.selection()) {
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    if (!any_held(s) || s.current == s.opened) continue;
    const auto fold = first_fold(*s.opened, *s.current, *s.visible);
    if (!fold) return std::unexpected(fold.error());
    if (*fold) return std::unexpected(fold_error(s, **fold));
  }
  return {};
}

Expected<std::string> Executor::keep_unfolded(std::string_view what, double whole,
                                              const std::function<Expected<void>(double)>& shows) {
  constexpr int halvings = 6;
  constexpr double safe = 0.9, least = 0.1;
  const auto sound = check_folds();
  if (sound) return std::string();
  double flat = 0, folded = whole;
  for (int k = 0; k < halvings; ++k) {
    const double middle = 0.5 * (flat + folded);
    if (auto shown = shows(middle); !shown) return std::unexpected(shown.error());
    (check_folds() ? flat : folded) = middle;
  }
  if (safe * flat < least * whole) return std::unexpected(sound.error());
  if (auto shown = shows(safe * flat); !shown) return std::unexpected(shown.error());
  if (auto still = check_folds(); !still) return std::unexpected(still.error());
  return fmt::format("the {} keeps {:.0f} % of its depth, as more would fold a face", what, 100 * safe * flat);
}

Expected<std::string> Executor::keep_stroke_unfolded() {
  return keep_unfolded("stroke", state.stroke->share, [this](double share) {
    state.stroke->share = share;
    return show_stroke(true);
  });
}

Expected<std::string> Executor::keep_step_unfolded(std::span<const std::shared_ptr<const Surface>> from, bool first,
                                                   const EvolutionPolicy& evolution) {
  const auto sound = check_folds();
  if (sound) return std::string();
  if (evolution.mode == Evolution::stationary) return std::unexpected(sound.error());
  const Scene whole = state;
  const auto shows = [&](double share) -> Expected<void> {
    for (const int k : state.selection()) {
      const auto at = static_cast<std::size_t>(k);
      const SceneSurface& moved = whole.surfaces[at];
      SceneSurface& s = state.surfaces[at];
      auto nearer = part_of_way(*from[at], moved.current, share);
      if (!nearer) return std::unexpected(nearer.error());
      if (*nearer == moved.current) continue;
      s.current = std::move(*nearer);
      if (moved.rest == moved.current) s.rest = s.current;
      s.velocity = share * moved.velocity;
    }
    return {};
  };
  auto note = keep_unfolded("step", 1, shows);
  if (note || first) {
    at_fold = note && !note->empty();
    return note;
  }
  at_fold = true;
  if (auto back = shows(0); !back) return std::unexpected(back.error());
  return "the step is not made, as it would fold a face";
}

bool Executor::holds_edges() const {
  return std::ranges::any_of(state.selection(), [this](int k) {
    return holds_trims(state.surfaces[static_cast<std::size_t>(k)].constraints);
  });
}

Error Executor::all_held(const std::string& tool) const {
  std::string by, remedy;
  Diagnostic diagnostic{ErrorCode::nothing_free, {{"tool", tool}}};
  const auto say = [&](ErrorCode code, const NamedValue& surface, const NamedValue& more) {
    if (code > diagnostic.code) diagnostic = {code, {{"tool", tool}, surface, more}};
  };
  for (int k : state.selection()) {
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    const auto [m, n] = s.current->net();
    std::string what;
    if (s.hold_rows > 0) {
      what = fmt::format("hold of {} rows on its net of {} x {}", s.hold_rows, m, n);
      remedy = R"(hold the edges of the face instead, {"do":"hold","mode":"trim"}, or fewer rows, or refine first)";
      say(ErrorCode::nothing_free_in_rows, {"surface", s.id}, {"rows", static_cast<double>(s.hold_rows)});
    } else if (holds_trims(s.constraints)) {
      what = fmt::format("hold of the edges of its faces on its net of {} x {}", m, n);
      remedy = state.permission == RefinePermission::never
                   ? R"(permit refining, {"do":"refine","permission":"trims"}, or free an edge)"
                   : "press farther from the edges, or free the one that is near";
      say(ErrorCode::nothing_free_at_edges, {"surface", s.id},
          {"permission", state.permission == RefinePermission::never ? "never" : "trims"});
    } else {
      what = "pins, frozen regions and held lines";
      remedy = "release some of it";
    }
    by += fmt::format("{}{}: {}", by.empty() ? "" : "; ", s.id, what);
  }
  return Error(ErrorKind::numerical, fmt::format("nothing is free to move under the tool {} ({})", tool, by), "step",
               remedy + R"(; or go on regardless with "allow":"held")")
      .with(std::move(diagnostic));
}

}  // namespace knead
