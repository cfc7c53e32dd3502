#include "motion_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/scene/trims.hpp"
#include "knead/spline/extremum.hpp"
#include "notes.hpp"
#include "scene/model/shell_model.hpp"
#include "stroking.hpp"
#include "trimming.hpp"

namespace knead {

bool held_all_round(const Act& act, std::span<const SeamReport> reports) {
  std::vector<SeamReport> seams(reports.begin(), reports.end());
  const std::vector<int> selection = act.state.selection();
  for (SeamReport& report : seams) {
    for (PatchEdge* side : {&report.seam.a, &report.seam.b}) {
      side->patch = selection[static_cast<std::size_t>(side->patch)];
    }
  }
  return knead::held_all_round(act.state, seams);
}

bool goes_too_far(Act& act, const ActiveStep& step, const ActiveLoads& loads, const Model& model) {
  if (!act.law || act.unruled || !(act.law->reach > 0) || loads.limit > 0 || has_shells(act.state) ||
      !held_all_round(act, model.seams())) {
    return false;
  }
  double room = (1 + 0.5 * law_tolerance) * act.law->reach, moved = 0;
  Eigen::Index first = 0;
  for (const OpenStroke::Before& from : act.law->from) {
    const auto there = from.current->with_control_points(step.control_points.middleRows(first, from.current->size()));
    first += from.current->size();
    if (there) moved = std::max(moved, largest_motion(*there, *from.current, room));
  }
  if (moved > room && !act.law->standing) {
    act.law->count_standing();
    room = (1 + 0.5 * law_tolerance) * act.law->reach;
  }
  return moved > room;
}

void MotionLaw::count_standing() {
  for (const OpenStroke::Before& before : from) reach = std::max(reach, standing_in(*before.current, tools));
  standing = true;
}

Points points_of_law(const Act& act) {
  Points result = active_state(act.state).control_points;
  Eigen::Index first = 0;
  for (const OpenStroke::Before& from : act.law->from) {
    result.middleRows(first, from.current->size()) = from.current->control_points();
    first += from.current->size();
  }
  return result;
}

namespace {

/// Motion is measured from the rest shapes as they are now, on the present nets, unless it is already.
void measure_from_rest(Act& act) {
  const std::vector<int> selection = act.state.selection();
  act.law->from.resize(selection.size());
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(selection[k])];
    OpenStroke::Before& from = act.law->from[k];
    if (!from.rest || !same_basis(*from.rest, *s.rest)) from = {s.rest, s.rest};
  }
}

/// The largest motion of a selected surface from the shapes of the law.
double motion(const Act& act, double enough) {
  double largest = 0;
  const std::vector<int> selection = act.state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(selection[k])];
    largest = std::max(largest, largest_motion(*s.current, *act.law->from[k].current, enough));
  }
  return largest;
}

}  // namespace

Expected<void> ask_of_motion(Act& act, const EvolutionPolicy& evolution, const std::vector<PointForce>& grips) {
  if (!only_pressed(act.state, evolution)) {
    act.unruled = true;
    return {};
  }
  const auto tools = tools_and_images(act.state);
  if (!tools) return std::unexpected(tools.error());
  const bool first = !act.law;
  if (first) act.law.emplace();
  measure_from_rest(act);
  double deepest = 0, way = 0;
  const std::vector<int> selection = act.state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(selection[k])];
    const Surface& shape = first ? *s.current : *act.law->from[k].current;
    deepest = std::max(deepest, depth_in(shape, *tools, holds_trims(s.constraints) ? s.visible.get() : nullptr));
  }
  const Points places = first ? active_state(act.state).control_points : points_of_law(act);
  for (const PointForce& grip : grips) {
    Point at = Point::Zero();
    for (const auto& [row, share] : grip.terms) at += share * places.row(row).transpose();
    way = std::max(way, (grip.to - at).norm());
  }
  const double reach = (first ? motion(act, 0) : 0) + std::max(deepest, way);
  if (reach >= act.law->reach) *act.law = {reach, std::move(act.law->from), *tools, grips};
  return {};
}

void keep_what_stroke_left(Act& act) {
  if (!only_pressed(act.state, act.state.evolution)) {
    act.unruled = true;
    return;
  }
  if (!act.law) act.law.emplace();
  act.law->from = act.state.stroke->before;
  const double left = std::sqrt(act.state.stroke->history.rowwise().squaredNorm().maxCoeff());
  act.law->reach = std::max(act.law->reach, left / (1 + 0.5 * law_tolerance));
}

void ask_of_stroke(Act& act, double moved, std::span<const Tool> tools) {
  if (!act.law || act.unruled) return;
  act.law->from = act.state.stroke->before;
  const double asked = moved / (1 + 0.5 * law_tolerance);
  if (asked <= act.law->reach) return;
  double depth = act.cache.stroke->depth_of(tools);
  if (asked > depth) {
    for (const OpenStroke::Before& before : act.state.stroke->before) {
      depth = std::max({depth, depth_in(*before.current, tools, nullptr), standing_in(*before.current, tools)});
    }
  }
  if (std::min(asked, depth) <= act.law->reach) return;
  act.law->reach = std::min(asked, depth);
  act.law->tools.assign(tools.begin(), tools.end());
  for (Tool& tool : act.law->tools) harden(tool, *act.state.stroke);
}

void ask_of_brush(Act& act, double asked) { act.law = MotionLaw{asked, act.state.brush->before}; }

namespace {

/// How far the static solution of the contact moves; 0: nothing holds the surfaces.
double static_motion(const Act& act) {
  Scene scene = act.state;
  const std::vector<int> selection = scene.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    SceneSurface& s = scene.surfaces[static_cast<std::size_t>(selection[k])];
    s.rest = s.current = act.law->from[k].current;
  }
  EvolutionPolicy evolution = act.state.evolution;
  evolution.mode = Evolution::stationary;
  const auto made = make_model(model_input(scene, evolution));
  if (!made) return 0;
  const ActiveState from = active_state(scene);
  ActiveLoads loads;
  loads.points = act.law->grips;
  const auto step = made->model.step(from, act.law->tools, loads);
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
Expected<void> move_less(Act& act, double share) {
  if (act.state.stroke) {
    act.state.stroke->share *= share;
    return show_stroke(act, true);
  }
  const std::vector<int> selection = act.state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(selection[k])];
    const bool same = s.rest == s.current;
    const OpenStroke::Before& from = act.law->from[k];
    auto current = part_of_way(*from.current, s.current, share);
    if (!current) return std::unexpected(current.error());
    auto rest = same ? current : part_of_way(*from.rest, s.rest, share);
    if (!rest) return std::unexpected(rest.error());
    s.current = std::move(*current);
    s.rest = std::move(*rest);
    s.velocity.resize(0, 3);
  }
  return check_folds(act.state);
}

Expected<void> keep_within(Act& act, MotionLaw& asked) {
  constexpr double most = 1 + law_tolerance;
  const double moved = motion(act, most * asked.reach);
  if (!(moved > most * asked.reach)) return {};
  const std::vector<int> selection = act.state.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {  // places of strokes were compared at samples
    asked.reach = std::max(asked.reach, depth_in(*asked.from[k].current, asked.tools, nullptr));
  }
  asked.count_standing();
  const bool lever =
      (!asked.tools.empty() || !asked.grips.empty()) && !knead::held_all_round(act.state, act.state.seam_reports);
  if (!(moved > most * asked.reach) || (lever && has_shells(act.state))) return {};
  const double bound = lever ? std::max(asked.reach, static_motion(act)) : asked.reach;
  if (!(moved > most * bound)) {
    note_last(act.state, "free sides move",
              fmt::format(" {:.2f} times as far as was asked for, as a lever does at rest; hold "
                          "them to prevent that",
                          moved / asked.reach));
    return {};
  }
  note_last(act.state, "made smaller",
            fmt::format(": {:.3g} of what it would have been, which moves {:.4g} where {:.4g} was "
                        "asked for",
                        bound / moved, moved, bound));
  return move_less(act, bound / moved);
}

}  // namespace

Expected<void> keep_law(Act& act) {
  const bool applies = act.law && !act.unruled && act.law->reach > 0;
  if (applies) {
    if (auto kept = keep_within(act, *act.law); !kept) return kept;
  }
  act.law.reset();
  act.unruled = false;
  return {};
}

}  // namespace knead
