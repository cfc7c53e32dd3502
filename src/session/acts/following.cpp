#include "following.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brep/shared_edge.hpp"
#include "holding.hpp"
#include "knead/base/error_code.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/spline/evaluate.hpp"
#include "refining.hpp"
#include "scene/followed.hpp"
#include "selection.hpp"
#include "session/command_fields.hpp"
#include "session/gestures/stroking.hpp"
#include "stepping.hpp"
#include "trimming.hpp"

namespace knead {
namespace {

// How tightly edges are coupled is found by trial: a step is solved with a tolerance τ
// (`CouplingTolerance`), the distance between both sides is measured, and where it is too large the
// step is solved again with a smaller τ. The error is about proportional to τ; the next τ aims at
// half of what is allowed. It is 0.4 times the last one or less, to end soon, and no less than 0.03
// times, since a τ that is too small takes freedom for nothing. The τ that was found is kept, so
// that most steps are solved once.
constexpr double least_coupling = 1e-9;
constexpr double tighter = 0.4, much_tighter = 0.03, half = 0.5;
// Of their motion that edges keep when they are coupled more tightly than they must.
constexpr double kept_motion = 0.9;

std::string list_of(std::vector<std::string> ids) {
  ids.erase(std::ranges::unique(ids).begin(), ids.end());  // both sides of a closed surface
  std::string text;
  for (const std::string& id : ids) text += (text.empty() ? "\"" : ",\"") + id + "\"";
  return text;
}

Expected<std::shared_ptr<const SharedEdge>> course_of(const Document& document,
                                                      const std::string& id) {
  if (document.source() == nullptr)
    return input_error("only edges of faces in a file can follow", id);
  if (auto can = document.source()->can_move_edge(id); !can) return std::unexpected(can.error());
  auto edge = SharedEdge::create(*document.model(), id);
  if (!edge) {
    Error error = edge.error();
    const brep::Model& model = *document.model();
    const std::vector<std::string> all = brep::surfaces_at_edge(model, id);
    std::vector<std::string> others = all;
    std::erase_if(
        others, [&](const std::string& surface) { return model.find_surface(surface) != nullptr; });
    if (!others.empty()) {
      error.remedy = fmt::format(
          R"(convert it, {{"do":"convert","surfaces":[{}]}}, and select all of its surfaces, )"
          R"({{"do":"select","surfaces":[{}]}}, or hold the edge)",
          list_of(others), list_of(all));
      if (error.diagnostic) {
        Diagnostic more = *error.diagnostic;
        more.values.emplace_back("surfaces", all);
        more.values.emplace_back("others", others);
        error = std::move(error).with(std::move(more));
      }
    }
    return std::unexpected(error);
  }
  return std::make_shared<const SharedEdge>(std::move(*edge));
}

/// What exceeds its tolerance so many times is about proportional to the coupling.
void tighten(double& coupling, double excess) {
  coupling = std::max(least_coupling, coupling * std::clamp(half / excess, much_tighter, tighter));
}

/// How much of a motion another one still is: the factor of the first that comes nearest to it.
double share_of(const std::vector<Point>& first, const std::vector<Point>& other) {
  double product = 0, square = 0;
  for (std::size_t k = 0; k < first.size(); ++k) {
    product += first[k].dot(other[k]);
    square += first[k].squaredNorm();
  }
  return square > 0 ? product / square : 1;
}

/// The angle up to which faces may meet at a smooth edge.
/// Twice the angle as opened: a file's own angle is not held against the step.
double accepted_bend(const Parting& parting) {
  return std::max(accepted_angle, 2 * parting.angle_before);
}

double in_degrees(double radians) { return radians * 180 / std::numbers::pi; }

}  // namespace

Expected<void> follow_edge(Act& act, const std::string& id) {
  auto found = std::ranges::find(act.state.followed, id, &FollowedEdge::id);
  if (found == act.state.followed.end() || !found->course) {
    auto course = course_of(act.document, id);
    if (!course) return std::unexpected(course.error());
    if (found == act.state.followed.end()) found = act.state.followed.insert(found, {id, {}});
    found->course = std::move(*course);
  }
  const auto is_selected = [&act](const std::string& surface) {
    return std::ranges::any_of(act.state.selection(), [&](int k) {
      return act.state.surfaces[static_cast<std::size_t>(k)].id == surface;
    });
  };
  const std::vector<std::string>& surfaces = found->course->surfaces();
  for (const std::string& surface : surfaces) {
    if (is_selected(surface)) continue;
    return input_error(
        fmt::format("the face on {} would have to follow the edge, but it is not selected",
                    surface),
        id,
        fmt::format(
            R"(select all of its surfaces, {{"do":"select","surfaces":[{}]}}, or hold the edge)",
            list_of(surfaces)),
        {ErrorCode::edge_face_not_selected,
         {{"edge", id}, {"surface", surface}, {"surfaces", surfaces}}});
  }
  return {};
}

Expected<void> know_followed(Act& act) {
  for (const SceneSurface& s : selected_surfaces(act.state)) {
    for (const KeptConstraint& kept : s.constraints) {
      const auto* hold = std::get_if<TrimEdgeHold>(&kept.constraint);
      if (hold == nullptr || !hold->follow) continue;
      if (auto known = follow_edge(act, hold->id); !known) return known;
    }
  }
  return {};
}

Expected<void> unite_followed(Act& act) {
  if (auto known = know_followed(act); !known) return known;
  if (act.state.permission == RefinePermission::never || followed_inputs(act.state).empty())
    return {};
  return refine_seams(act, true);
}

// The last word on every command that moved a surface, whatever moved it: distance first, then the
// angle at smooth edges, then vertices that other edges hold. Only edges of which some surface
// changed are measured.
Expected<void> check_followed(const Scene& scene, const Scene& before) {
  if (std::ranges::equal(
          scene.surfaces, before.surfaces,
          [](const SceneSurface& a, const SceneSurface& b) { return a.current == b.current; })) {
    return {};  // nothing moved
  }
  for (const FollowedEdge& edge : scene.followed) {
    if (!edge.course) continue;
    bool following = true, changed = false;
    for (const std::string& id : edge.course->surfaces()) {
      const auto is = std::ranges::find(scene.surfaces, id, &SceneSurface::id);
      const auto was = std::ranges::find(before.surfaces, id, &SceneSurface::id);
      following = following && is != scene.surfaces.end() && follows(*is, edge.id);
      changed = changed || was == before.surfaces.end() || is == scene.surfaces.end() ||
                was->current != is->current;
    }
    if (!following || !changed) continue;
    const auto apart = parting(scene, *edge.course);
    if (!apart) return std::unexpected(apart.error());
    if (apart->distance > apart->tolerance) {
      const Point& p = apart->place;
      return numerical_error(
          fmt::format("the faces at the edge {} would part by {:.2g} at ({:.6g}, {:.6g}, {:.6g}), "
                      "more than the tolerance of {:.2g}; this was refused",
                      edge.id, apart->distance, p.x(), p.y(), p.z(), apart->tolerance),
          "edge",
          R"(refine the surfaces near the edge with {"do":"refine"}, move it less, or hold it)",
          {ErrorCode::edge_would_part, {{"edge", edge.id}}});
    }
    if (apart->angle > accepted_bend(*apart)) {
      const Point& p = apart->kink_place;
      return numerical_error(
          fmt::format("the faces at the smooth edge {} would meet at {:.2g} degrees at ({:.6g}, "
                      "{:.6g}, {:.6g}), more than the {:.2g} that are accepted; this was refused",
                      edge.id, in_degrees(apart->angle), p.x(), p.y(), p.z(),
                      in_degrees(accepted_bend(*apart))),
          "edge",
          R"(refine the surfaces near the edge with {"do":"refine"}, move it less, )"
          R"(or hold it "tangent")",
          {ErrorCode::edge_would_part, {{"edge", edge.id}}});
    }
    const auto stuck = stuck_vertex(scene, *edge.course);
    if (!stuck) return std::unexpected(stuck.error());
    if (*stuck) {
      return numerical_error(
          fmt::format("the vertex {} of the edge {} would move by {:.2g}, but the edge {} stays",
                      (*stuck)->vertex, edge.id, (*stuck)->distance, (*stuck)->edge),
          "edge", "let that edge follow too, or hold this one");
    }
  }
  return {};
}

Attempts::Attempts(const Scene& scene, std::span<const OpenStroke::Before> selected) {
  for (const SceneSurface& s : scene.surfaces) before_.push_back(s.current);
  const std::vector<int> selection = scene.selection();
  for (std::size_t k = 0; k < selected.size(); ++k) {
    before_[static_cast<std::size_t>(selection[k])] = selected[k].current;
  }
}

namespace {

/// By how much points of an edge moved, on its first surface.
Expected<void> append_motion(const Scene& scene, const SharedEdge& edge,
                             std::span<const std::shared_ptr<const Surface>> before,
                             std::vector<Point>& to) {
  const auto k = static_cast<std::size_t>(
      std::ranges::find(scene.surfaces, edge.surfaces().front(), &SceneSurface::id) -
      scene.surfaces.begin());
  for (const SharedEdge::Sample& sample : edge.samples()) {
    const auto way = displacement_at(*before[k], *scene.surfaces[k].current, sample.feet.front());
    if (!way) return std::unexpected(way.error());
    to.push_back(*way);
  }
  return {};
}

}  // namespace

// All edges share the two tolerances of the scene, so that the worst of each measure decides. Two
// outcomes end the attempts. Either everything is as asked; or some attempt could be accepted
// (`best_`, closed, with angles up to `accepted_angle`), and a tighter one keeps less than 90 % of
// its motion: then two nets have too little in common there, and the accepted one is taken and its
// angle asked for from here on. Otherwise the tolerances are reduced, `along` counting for
// positions and `across` for tangents (`look_for_kink`); if they are at their least, what is left
// is for `check_followed` to refuse.
Expected<bool> Attempts::together(SessionState& state) {
  double excess = 0, across = 0, along = 0, angle = 0;
  std::vector<Point> motion;
  for (const FollowedInput& edge : followed_inputs(state)) {
    const auto apart = parting(state, *edge.course);
    if (!apart) return std::unexpected(apart.error());
    excess = std::max(excess, apart->distance / apart->tolerance);
    angle = std::max(angle, apart->angle / accepted_bend(*apart));
    across = std::max(across, apart->kink_across);
    along = std::max(along, apart->kink_along);
    if (auto moved = append_motion(state, *edge.course, before_, motion); !moved) {
      return std::unexpected(moved.error());
    }
  }
  if (best_ && share_of(best_->motion, motion) <
                   kept_motion) {  // what is asked for would take the freedom that the edges have
    state.surfaces = std::move(best_->surfaces);
    state.coupling = best_->coupling;
    state.bend = accepted_angle;
    state.notes.push_back(
        fmt::format("smooth edges that follow may open by up to {:.2g} degrees from here on: "
                    "within the {:.2g} that are asked for they could hardly move; finer nets "
                    "beside them would help, {{\"do\":\"refine\"}}",
                    in_degrees(accepted_angle), in_degrees(asked_angle)));
    return true;
  }
  const CouplingTolerance was = state.coupling;
  if (excess <= 1 && angle <= 1) {
    // The larger angle has been granted before: there is nothing better to try for.
    if (state.bend > asked_angle) return true;
    best_ = {state.surfaces, was, best_ ? std::move(best_->motion) : std::move(motion)};
  }
  if (std::max(excess, along) > 1) tighten(state.coupling.position, std::max(excess, along));
  if (across > 1) tighten(state.coupling.tangent, across);
  return state.coupling == was;
}

Expected<bool> Attempts::accept(Act& act, const ActiveStep& step) {
  const Scene before = act.state;
  if (auto taken = take(act, step); !taken) return std::unexpected(taken.error());
  const auto closed = together(act.state);
  if (!closed) return closed;
  if (!*closed) {
    act.state.surfaces = before.surfaces;
    return false;
  }
  if (auto checked = check_followed(act.state, before); !checked)
    return std::unexpected(checked.error());
  return true;
}

}  // namespace knead
