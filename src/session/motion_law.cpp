#include "motion_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "executor.hpp"
#include "knead/scene/trims.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {

bool Executor::held_all_round(std::span<const SeamReport> reports) const {
  std::vector<SeamReport> seams(reports.begin(), reports.end());
  const std::vector<int> selection = state.selection();
  for (SeamReport& report : seams) {
    for (PatchEdge* side : {&report.seam.a, &report.seam.b}) {
      side->patch = selection[static_cast<std::size_t>(side->patch)];
    }
  }
  return knead::held_all_round(state, seams);
}

/// Whether a step moves further than was asked for, by so much that it is made again within reach.
bool Executor::goes_too_far(const ActiveStep& step, const ActiveLoads& loads, const Model& model) {
  if (!law || unruled || !(law->reach > 0) || loads.limit > 0 || shells() || !held_all_round(model.seams())) {
    return false;
  }
  double room = (1 + 0.5 * law_tolerance) * law->reach, moved = 0;
  Eigen::Index first = 0;
  for (const OpenStroke::Before& from : law->from) {
    const auto there = from.current->with_control_points(step.control_points.middleRows(first, from.current->size()));
    first += from.current->size();
    if (there) moved = std::max(moved, largest_motion(*there, *from.current, room));
  }
  if (moved > room && !law->standing) {
    law->count_standing();
    room = (1 + 0.5 * law_tolerance) * law->reach;
  }
  return moved > room;
}

void MotionLaw::count_standing() {
  for (const OpenStroke::Before& before : from) reach = std::max(reach, standing_in(*before.current, tools));
  standing = true;
}

/// The displacement of a place of a stroke, made again where it goes further than these tools stand in the shapes from
/// before the stroke: beside what is held inside a tool a surface swings out, far beyond the tool where that is large.
Expected<ActiveStep> Executor::within_depth(ActiveStep step, const ActiveState& from, std::span<const Tool> tools,
                                            ActiveLoads loads) const {
  if (loads.limit > 0 || !held_all_round(stroke_cache->scene.seams)) return step;
  const double room = 1 + 0.5 * law_tolerance;
  const double moved = std::sqrt(stroke_cache->at_abscissae(step.control_points).rowwise().squaredNorm().maxCoeff());
  if (moved <= room * depth_at_sites(tools)) return step;
  double depth = 0;
  for (const OpenStroke::Before& before : state.stroke->before) {
    depth = std::max({depth, depth_in(*before.current, tools, nullptr), standing_in(*before.current, tools)});
  }
  if (moved <= room * depth) return step;
  loads.reach = depth;
  loads.original = from.control_points;
  auto shorter = stroke_cache->scene.model.step(from, tools, loads);
  if (shorter) shorter->control_points -= from.control_points;
  return shorter;
}

Points Executor::points_of_law() const {
  Points result = active_state(state).control_points;
  Eigen::Index first = 0;
  for (const OpenStroke::Before& from : law->from) {
    result.middleRows(first, from.current->size()) = from.current->control_points();
    first += from.current->size();
  }
  return result;
}

/// What the tools and these grips ask: at first of the surfaces as they stand, beyond what moved them before; where the
/// command goes on with others, of the shapes that motion is measured from, so that what one step moved too far does
/// not count for the next.
Expected<void> Executor::ask_of_motion(const EvolutionPolicy& evolution, const std::vector<PointForce>& grips) {
  if (!only_pressed(state, evolution)) {
    unruled = true;
    return {};
  }
  const auto tools = tools_and_images(state);
  if (!tools) return std::unexpected(tools.error());
  const bool first = !law;
  if (first) law.emplace();
  measure_from_rest();
  double deepest = 0, way = 0;
  const std::vector<int> selection = state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(selection[k])];
    const Surface& shape = first ? *s.current : *law->from[k].current;
    deepest = std::max(deepest, depth_in(shape, *tools, holds_trims(s.constraints) ? s.visible.get() : nullptr));
  }
  const Points places = first ? active_state(state).control_points : points_of_law();
  for (const PointForce& grip : grips) {
    Point at = Point::Zero();
    for (const auto& [row, share] : grip.terms) at += share * places.row(row).transpose();
    way = std::max(way, (grip.to - at).norm());
  }
  const double reach = (first ? motion(0) : 0) + std::max(deepest, way);
  if (reach >= law->reach) *law = {reach, std::move(law->from), *tools, grips};
  return {};
}

/// Motion is measured from the rest shapes as they are now, on the present nets, unless it is already.
void Executor::measure_from_rest() {
  const std::vector<int> selection = state.selection();
  law->from.resize(selection.size());
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(selection[k])];
    OpenStroke::Before& from = law->from[k];
    if (!from.rest || !same_basis(*from.rest, *s.rest)) from = {s.rest, s.rest};
  }
}

/// What the open stroke has left so far may stay, whatever places asked for it.
void Executor::keep_what_stroke_left() {
  if (!only_pressed(state, state.evolution)) {
    unruled = true;
    return;
  }
  if (!law) law.emplace();
  law->from = state.stroke->before;
  const double left = std::sqrt(state.stroke->history.rowwise().squaredNorm().maxCoeff());
  law->reach = std::max(law->reach, left / (1 + 0.5 * law_tolerance));
}

/// What tools ask of the shapes from before the stroke, where they moved them so far: by no more than half the
/// tolerance further than they stand in them, which is measured exactly only where they did.
void Executor::ask_of_stroke(double moved, std::span<const Tool> tools) {
  if (!law || unruled) return;
  law->from = state.stroke->before;
  const double asked = moved / (1 + 0.5 * law_tolerance);
  if (asked <= law->reach) return;
  double depth = depth_at_sites(tools);
  if (asked > depth) {
    for (const OpenStroke::Before& before : state.stroke->before) {
      depth = std::max({depth, depth_in(*before.current, tools, nullptr), standing_in(*before.current, tools)});
    }
  }
  if (std::min(asked, depth) <= law->reach) return;
  law->reach = std::min(asked, depth);
  law->tools.assign(tools.begin(), tools.end());
  for (Tool& tool : law->tools) harden(tool, *state.stroke);
}

/// The same of a brush.
void Executor::ask_of_brush(double asked) { law = MotionLaw{asked, state.brush->before}; }

/// The largest motion of a selected surface from the shapes of the law.
double Executor::motion(double enough) const {
  double largest = 0;
  const std::vector<int> selection = state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(selection[k])];
    largest = std::max(largest, largest_motion(*s.current, *law->from[k].current, enough));
  }
  return largest;
}

/// How far the static solution of the contact moves; 0: nothing holds the surfaces.
double Executor::static_motion() const {
  Scene scene = state;
  const std::vector<int> selection = scene.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    SceneSurface& s = scene.surfaces[static_cast<std::size_t>(selection[k])];
    s.rest = s.current = law->from[k].current;
  }
  EvolutionPolicy evolution = state.evolution;
  evolution.mode = Evolution::stationary;
  const auto made = make_model(model_input(scene, evolution));
  if (!made) return 0;
  const ActiveState from = active_state(scene);
  ActiveLoads loads;
  loads.points = law->grips;
  const auto step = made->model.step(from, law->tools, loads);
  if (!step) return 0;
  double largest = 0;
  Eigen::Index first = 0;
  for (const int k : selection) {
    const Surface& rest = *scene.surfaces[static_cast<std::size_t>(k)].rest;
    const auto there = rest.with_control_points(step->control_points.middleRows(first, rest.size()));
    first += rest.size();
    if (there) largest = std::max(largest, largest_distance(*there, rest));
  }
  return largest;
}

/// All that this command moved, made smaller alike: what is held is linear in displacements.
Expected<void> Executor::move_less(double share) {
  if (state.stroke) {
    state.stroke->share *= share;
    return show_stroke(true);
  }
  const std::vector<int> selection = state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(selection[k])];
    const bool same = s.rest == s.current;
    const OpenStroke::Before& from = law->from[k];
    auto current = part_of_way(*from.current, s.current, share);
    if (!current) return std::unexpected(current.error());
    auto rest = same ? current : part_of_way(*from.rest, s.rest, share);
    if (!rest) return std::unexpected(rest.error());
    s.current = std::move(*current);
    s.rest = std::move(*rest);
    s.velocity.resize(0, 3);
  }
  return check_folds();
}

/// A note of which only the last stands.
void Executor::note_motion(std::string_view begins, const std::string& note, Diagnostic read) {
  std::erase_if(state.notes, [&](const std::string& n) { return n.starts_with(begins); });
  state.notes.emplace_back(std::string(begins) + note, std::move(read));
}

Expected<void> Executor::keep_law() {
  const bool applies = law && !unruled && law->reach > 0;
  if (applies) {
    if (auto kept = keep_law(*law); !kept) return kept;
  }
  law.reset();
  unruled = false;
  return {};
}

Expected<void> Executor::keep_law(MotionLaw& asked) {
  constexpr double most = 1 + law_tolerance;
  const double moved = motion(most * asked.reach);
  if (!(moved > most * asked.reach)) return {};
  const std::vector<int> selection = state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {  // places of strokes were compared at samples
    asked.reach = std::max(asked.reach, depth_in(*asked.from[k].current, asked.tools, nullptr));
  }
  asked.count_standing();
  const bool lever =
      (!asked.tools.empty() || !asked.grips.empty()) && !knead::held_all_round(state, state.seam_reports);
  if (!(moved > most * asked.reach) || (lever && shells())) return {};
  const double bound = lever ? std::max(asked.reach, static_motion()) : asked.reach;
  if (!(moved > most * bound)) {
    note_motion("free sides move", fmt::format(" {:.2f} times as far as was asked for, as a lever does at rest; hold "
                                               "them to prevent that",
                                               moved / asked.reach));
    return {};
  }
  note_motion("made smaller", fmt::format(": {:.3g} of what it would have been, which moves {:.4g} where {:.4g} was "
                                          "asked for",
                                          bound / moved, moved, bound));
  return move_less(bound / moved);
}

}  // namespace knead
