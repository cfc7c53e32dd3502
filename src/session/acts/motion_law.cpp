#include "motion_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "act.hpp"
#include "knead/spline/extremum.hpp"
#include "notes.hpp"
#include "scene/model/shell_model.hpp"
#include "scene/trims.hpp"
#include "session/gestures/stroking.hpp"
#include "trimming.hpp"

namespace knead {

std::vector<SeamReport> seams_in_scene(std::span<const SeamReport> reports, const Scene& scene) {
  std::vector<SeamReport> seams(reports.begin(), reports.end());
  const std::vector<int> selection = scene.selection();
  for (SeamReport& report : seams) {
    for (PatchEdge* side : {&report.seam.a, &report.seam.b}) {
      side->patch = selection[static_cast<std::size_t>(side->patch)];
    }
  }
  return seams;
}

double depth_in_shapes(std::span<const OpenStroke::Before> shapes, std::span<const Tool> tools) {
  double depth = 0;
  for (const OpenStroke::Before& shape : shapes) {
    depth = std::max(
        {depth, depth_in(*shape.current, tools, nullptr), standing_in(*shape.current, tools)});
  }
  return depth;
}

void MotionLaw::count_standing() {
  for (const OpenStroke::Before& before : from_)
    reach_ = std::max(reach_, standing_in(*before.current, tools_));
  standing_ = true;
}

/// Motion is measured from the rest shapes as they are now, on the present nets, unless it is
/// already.
void MotionLaw::measure_from_rest(const Scene& scene) {
  const std::vector<int> selection = scene.selection();
  from_.resize(selection.size());
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(selection[k])];
    if (!from_[k].rest || !same_basis(*from_[k].rest, *s.rest)) from_[k] = {s.rest, s.rest};
  }
}

/// The control points from which motion is measured.
Points MotionLaw::points_from(const Scene& scene) const {
  Points result = active_state(scene).control_points;
  Eigen::Index first = 0;
  for (const OpenStroke::Before& from : from_) {
    result.middleRows(first, from.current->size()) = from.current->control_points();
    first += from.current->size();
  }
  return result;
}

/// The largest motion of a selected surface, an upper bound where that is below `enough`.
double MotionLaw::motion(const Scene& scene, double enough) const {
  double largest = 0;
  const std::vector<int> selection = scene.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(selection[k])];
    largest = std::max(largest, largest_motion(*s.current, *from_[k].current, enough));
  }
  return largest;
}

Expected<void> MotionLaw::ask_of_steps(const Scene& scene, const EvolutionPolicy& evolution,
                                       const std::vector<PointForce>& grips) {
  if (!only_pressed(scene, evolution)) {
    unruled_ = true;
    return {};
  }
  auto tools = tools_and_images(scene);
  if (!tools) return std::unexpected(tools.error());
  const bool first = !std::exchange(asked_, true);
  measure_from_rest(scene);
  double deepest = 0, way = 0;
  const std::vector<int> selection = scene.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(selection[k])];
    const Surface& shape = first ? *s.current : *from_[k].current;
    deepest = std::max(
        deepest, depth_in(shape, *tools, holds_trims(s.constraints) ? s.visible.get() : nullptr));
  }
  const Points places = first ? active_state(scene).control_points : points_from(scene);
  for (const PointForce& grip : grips) {
    Point at = Point::Zero();
    for (const auto& [row, share] : grip.terms) at += share * places.row(row).transpose();
    way = std::max(way, (grip.to - at).norm());
  }
  const double reach = (first ? motion(scene, 0) : 0) + std::max(deepest, way);
  if (reach < reach_) return {};
  reach_ = reach;
  tools_ = std::move(*tools);
  grips_ = grips;
  standing_ = false;
  return {};
}

void MotionLaw::keep_what_stroke_left(const Scene& scene) {
  if (!only_pressed(scene, scene.evolution)) {
    unruled_ = true;
    return;
  }
  asked_ = true;
  from_ = scene.stroke->before;
  const double left = std::sqrt(scene.stroke->history.rowwise().squaredNorm().maxCoeff());
  reach_ = std::max(reach_, left / (1 + 0.5 * law_tolerance));
}

void MotionLaw::ask_of_stroke(const OpenStroke& stroke, const StrokeModel& model, double moved,
                              std::span<const Tool> tools) {
  if (!asked_ || unruled_) return;
  from_ = stroke.before;
  const double asked = moved / (1 + 0.5 * law_tolerance);
  if (asked <= reach_) return;
  double depth = model.depth_of(tools);
  if (asked > depth) depth = std::max(depth, depth_in_shapes(stroke.before, tools));
  if (std::min(asked, depth) <= reach_) return;
  reach_ = std::min(asked, depth);
  tools_.assign(tools.begin(), tools.end());
  for (Tool& tool : tools_) harden(tool, stroke);
}

void MotionLaw::ask_of_brush(const OpenBrush& brush, double asked) {
  *this = {};
  asked_ = true;
  reach_ = asked;
  from_ = brush.before;
}

// A step that goes beyond the reach is solved once more with that as a limit on displacements,
// which costs a second solve; half of the tolerance is left for what is measured at samples.
// Surfaces with free sides swing as levers and are not limited (`share_allowed` judges them by the
// static solution), and shells have no limit in their steps.
bool MotionLaw::shortens(const Scene& scene, const ActiveStep& step, ActiveLoads& loads,
                         const Model& model) {
  if (!bounds() || loads.limit > 0 || has_shells(scene) ||
      !held_all_round(scene, seams_in_scene(model.seams(), scene))) {
    return false;
  }
  double room = (1 + 0.5 * law_tolerance) * reach_, moved = 0;
  Eigen::Index first = 0;
  for (const OpenStroke::Before& from : from_) {
    const auto there = from.current->with_control_points(
        step.control_points.middleRows(first, from.current->size()));
    first += from.current->size();
    if (there) moved = std::max(moved, largest_motion(*there, *from.current, room));
  }
  if (moved > room && !standing_) {
    count_standing();
    room = (1 + 0.5 * law_tolerance) * reach_;
  }
  if (!(moved > room)) return false;
  loads.reach = reach_;
  loads.original = points_from(scene);
  return true;
}

/// How far the static solution of the contact moves; 0: nothing holds the surfaces.
double MotionLaw::static_motion(Scene scene) const {
  const std::vector<int> selection = scene.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    SceneSurface& s = scene.surfaces[static_cast<std::size_t>(selection[k])];
    s.rest = s.current = from_[k].current;
  }
  EvolutionPolicy evolution = scene.evolution;
  evolution.mode = Evolution::stationary;
  const auto made = make_model(model_input(scene, evolution));
  if (!made) return 0;
  ActiveLoads loads;
  loads.points = grips_;
  const auto step = made->model.step(active_state(scene), tools_, loads);
  if (!step) return 0;
  double largest = 0;
  Eigen::Index first = 0;
  for (const OpenStroke::Before& from : from_) {
    const Surface& rest = *from.current;
    const auto there =
        rest.with_control_points(step->control_points.middleRows(first, rest.size()));
    first += rest.size();
    if (there) largest = std::max(largest, largest_distance(*there, rest));
  }
  return largest;
}

// Bounds are computed from the cheapest to the dearest, and only while the motion exceeds what is
// known: the reach of the command, the depth of tools in the shapes between samples, how far tools
// stand in them, and, with free sides, the static solution, which costs a model of its own. Most
// commands end at the first.
std::optional<double> MotionLaw::share_allowed(SessionState& state) {
  constexpr double most = 1 + law_tolerance;
  const double moved = motion(state, most * reach_);
  if (!(moved > most * reach_)) return {};
  for (const OpenStroke::Before& from : from_) {  // places of strokes were compared at samples
    reach_ = std::max(reach_, depth_in(*from.current, tools_, nullptr));
  }
  count_standing();
  const bool lever =
      (!tools_.empty() || !grips_.empty()) && !held_all_round(state, state.seam_reports);
  if (!(moved > most * reach_) || (lever && has_shells(state))) return {};
  const double bound = lever ? std::max(reach_, static_motion(state)) : reach_;
  if (!(moved > most * bound)) {
    note_last(state, "free sides move",
              fmt::format(" {:.2f} times as far as was asked for, as a lever does at rest; hold "
                          "them to prevent that",
                          moved / reach_));
    return {};
  }
  note_last(
      state, "made smaller",
      fmt::format(
          ": {:.3g} of what it would have been, which moves {:.4g} where {:.4g} was asked for",
          bound / moved, moved, bound));
  return bound / moved;
}

// Everything held is linear in displacements: a share of a motion that keeps it keeps it too.
Expected<void> MotionLaw::make_smaller(Scene& scene, double share) const {
  const std::vector<int> selection = scene.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    SceneSurface& s = scene.surfaces[static_cast<std::size_t>(selection[k])];
    const bool same = s.rest == s.current;
    auto current = part_of_way(*from_[k].current, s.current, share);
    if (!current) return std::unexpected(current.error());
    auto rest = same ? current : part_of_way(*from_[k].rest, s.rest, share);
    if (!rest) return std::unexpected(rest.error());
    s.current = std::move(*current);
    s.rest = std::move(*rest);
    s.velocity.resize(0, 3);
  }
  return check_folds(scene);
}

Expected<void> keep_law(Act& act) {
  MotionLaw law = std::exchange(act.law, {});
  if (!law.bounds()) return {};
  const auto share = law.share_allowed(act.state);
  if (!share) return {};
  return act.state.stroke ? Stroke(act).keep_share(*share) : law.make_smaller(act.state, *share);
}

}  // namespace knead
