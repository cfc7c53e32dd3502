#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "command_fields.hpp"
#include "knead/exchange/shared_edge.hpp"
#include "knead/scene/followed.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

constexpr double least_coupling = 1e-9;
constexpr double fine_coupling = 1e-3;
constexpr double tighter = 0.25, much_tighter = 0.03;  // above and below that

Expected<std::shared_ptr<const SharedEdge>> course_of(const Document& document, const std::string& id) {
  if (document.step_file() == nullptr) return input_error("only edges of faces in a STEP file can follow", id);
  auto edge = SharedEdge::create(*document.step_file(), id);
  if (!edge) return std::unexpected(edge.error());
  return std::make_shared<const SharedEdge>(std::move(*edge));
}

std::string list_of(const std::vector<std::string>& ids) {
  std::string text;
  for (const std::string& id : ids) text += (text.empty() ? "\"" : ",\"") + id + "\"";
  return text;
}

}  // namespace

Expected<void> Executor::follow_edge(const std::string& id) {
  auto found = std::ranges::find(state.followed, id, &FollowedEdge::id);
  if (found == state.followed.end() || !found->course) {
    auto course = course_of(document, id);
    if (!course) return std::unexpected(course.error());
    if (found == state.followed.end()) found = state.followed.insert(found, {id, {}});
    found->course = std::move(*course);
  }
  const auto is_selected = [this](const std::string& surface) {
    return std::ranges::any_of(state.selection(),
                               [&](int k) { return state.surfaces[static_cast<std::size_t>(k)].id == surface; });
  };
  const std::vector<std::string>& surfaces = found->course->surfaces();
  for (const std::string& surface : surfaces) {
    if (is_selected(surface)) continue;
    return input_error(fmt::format("the face on {} would have to follow the edge, but it is not selected", surface), id,
                       fmt::format(R"(select all of its surfaces, {{"do":"select","surfaces":[{}]}}, or hold the edge)",
                                   list_of(surfaces)));
  }
  return {};
}

Expected<void> Executor::know_followed() {
  for (int k : state.selection()) {
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    for (const KeptConstraint& kept : s.constraints) {
      const auto* hold = std::get_if<TrimEdgeHold>(&kept.constraint);
      if (hold == nullptr || !hold->follow) continue;
      if (auto known = follow_edge(hold->id); !known) return known;
    }
  }
  return {};
}

Expected<void> Executor::check_followed(const Scene& before) {
  for (const FollowedEdge& edge : state.followed) {
    if (!edge.course) continue;
    bool following = true, changed = false;
    for (const std::string& id : edge.course->surfaces()) {
      const auto is = std::ranges::find(state.surfaces, id, &SceneSurface::id);
      const auto was = std::ranges::find(before.surfaces, id, &SceneSurface::id);
      following = following && is != state.surfaces.end() && follows(*is, edge.id);
      changed = changed || was == before.surfaces.end() || is == state.surfaces.end() || was->current != is->current;
    }
    if (!following || !changed) continue;
    const auto apart = parting(state, *edge.course);
    if (!apart) return std::unexpected(apart.error());
    if (apart->distance > apart->tolerance) {
      const Point& p = apart->place;
      return numerical_error(
          fmt::format("the faces at the edge {} would part by {:.2g} at ({:.6g}, {:.6g}, {:.6g}), more than the "
                      "tolerance of {:.2g}; this was refused",
                      edge.id, apart->distance, p.x(), p.y(), p.z(), apart->tolerance),
          "edge", R"(refine the surfaces near the edge with {"do":"refine"}, move it less, or hold it)");
    }
    const auto stuck = stuck_vertex(state, *edge.course);
    if (!stuck) return std::unexpected(stuck.error());
    if (*stuck) {
      return numerical_error(fmt::format("the vertex {} of the edge {} would move by {:.2g}, but the edge {} stays",
                                         (*stuck)->vertex, edge.id, (*stuck)->distance, (*stuck)->edge),
                             "edge", "let that edge follow too, or hold this one");
    }
  }
  return {};
}

Expected<bool> Executor::take_together(const ActiveStep& step) {
  const std::vector<FollowedInput> followed = followed_inputs(state);
  if (followed.empty()) {
    if (auto taken = take(step); !taken) return std::unexpected(taken.error());
    return true;
  }
  const Scene before = state;
  if (auto taken = take(step); !taken) return std::unexpected(taken.error());
  double excess = 0;
  for (const FollowedInput& edge : followed) {
    const auto apart = parting(state, *edge.course);
    if (!apart) return std::unexpected(apart.error());
    excess = std::max(excess, apart->distance / apart->tolerance);
  }
  if (excess <= 1 || state.coupling <= least_coupling) {
    if (auto closed = check_followed(before); !closed) return std::unexpected(closed.error());
    return true;
  }
  state.surfaces = before.surfaces;
  state.coupling = std::max(least_coupling, state.coupling * (state.coupling > fine_coupling ? tighter : much_tighter));
  return false;
}

Expected<void> Executor::refine_followed(const SceneSurface& touched, const TrimContact& contact, double size) {
  const auto place = evaluate_point<2>(*touched.opened, contact.at);
  if (!place) return std::unexpected(place.error());
  for (const FollowedEdge& edge : state.followed) {
    if (!edge.course || !follows(touched, edge.id)) continue;
    const auto& samples = edge.course->samples();
    const auto near =
        std::ranges::min_element(samples, {}, [&](const SharedEdge::Sample& s) { return (s.point - *place).norm(); });
    if ((near->point - *place).norm() >= contact.distance) continue;
    for (std::size_t k = 0; k < near->feet.size(); ++k) {
      const auto index = find_surface(edge.course->surfaces()[k]);
      if (!index) return std::unexpected(index.error());
      SceneSurface& s = state.surfaces[static_cast<std::size_t>(*index)];
      if (&s == &touched || !s.visible) continue;
      std::vector<bool> held;
      for (const int order : trim_orders(s.constraints, *s.visible)) held.push_back(order >= 0);
      TrimContact there{parameters_at_foot(*s.current, near->feet[k]), s.visible->distance(near->point, held)};
      there.distance = std::min(there.distance, contact.distance);
      if (!(there.distance > 0)) continue;
      if (auto done = refine_round(s, there, size); !done) return done;
    }
  }
  return {};
}

}  // namespace knead
