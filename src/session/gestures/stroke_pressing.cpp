#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/anchors.hpp"
#include "scene/model/shell_model.hpp"
#include "session/acts/following.hpp"
#include "session/acts/trimming.hpp"
#include "stroking.hpp"

namespace knead {
namespace {

Expected<Coefficient<2>> raised(const Coefficient<2>& c, double by) {
  if (const double* constant = std::get_if<double>(&c)) return Coefficient<2>(*constant + by);
  const auto& field = std::get<SplineField<2>>(c);
  std::vector<double> all = field.coefficients();
  for (double& x : all) x += by;
  auto made = SplineField<2>::create(field.knots(), std::move(all));
  if (!made) return std::unexpected(made.error());
  return Coefficient<2>(std::move(*made));
}

Points stacked(const std::vector<OpenStroke::Before>& shapes,
               std::shared_ptr<const Surface> OpenStroke::Before::*which) {
  Eigen::Index rows = 0;
  for (const OpenStroke::Before& s : shapes) rows += (s.*which)->size();
  Points result(rows, 3);
  rows = 0;
  for (const OpenStroke::Before& s : shapes) {
    result.middleRows(rows, (s.*which)->size()) = (s.*which)->control_points();
    rows += (s.*which)->size();
  }
  return result;
}

}  // namespace

// A stroke presses a plate on a bed: stiffness K as the material has it, with the stroke's tension
// added to both α, plus λ M, which pulls to the shapes from before. So a dent is felt over the
// bed's length alone (`locality_of`), and the groove does not depend on how large the surface is.
Expected<void> prepare_stroke_model(Act& act) {
  if (auto known = know_trims(act); !known) return known;
  if (auto known = know_followed(act); !known) return known;
  const OpenStroke& stroke = *act.state.stroke;
  EvolutionPolicy evolution;
  evolution.lambda = stroke.lambda;
  evolution.accuracy = act.state.evolution.accuracy;
  evolution.solver = act.state.evolution.solver;
  evolution.energy_tolerance = act.state.evolution.energy_tolerance;
  ModelInput input = model_input(act.state, evolution);
  for (std::size_t k = 0; k < input.shapes.size(); ++k) {
    SurfaceInput& s = input.shapes[k];
    if (s.rest) s.rest = stroke.before[k].rest;
    for (std::size_t i : pure_terms) {
      auto alpha = raised(s.material.alpha[i], stroke.tension);
      if (!alpha) return std::unexpected(alpha.error());
      s.material.alpha[i] = std::move(*alpha);
    }
  }
  return keep_stroke_model(act.cache.stroke, std::move(input), stroke.before);
}

void harden(Tool& tool, const OpenStroke& stroke) {
  if (tool.collides())
    tool.stiffness = std::min(std::max(tool.stiffness, stroke.stiffness), max_tool_stiffness);
}

namespace {

/// What the tools of the open stroke ask of shells, on the stroke's bed. The shapes from before the
/// stroke are those of no stress here: what they carry is in balance with the forces on them, which
/// are therefore left out.
Expected<ActiveStep> press_shell_on_bed(Act& act, const std::vector<Tool>& tools, Points guess) {
  const OpenStroke& stroke = *act.state.stroke;
  Scene before = act.state;
  const std::vector<int> selection = before.selection();
  for (std::size_t k = 0; k < selection.size(); ++k) {
    SceneSurface& s = before.surfaces[static_cast<std::size_t>(selection[k])];
    s.rest = s.current = stroke.before[k].current;
    s.velocity.resize(0, 3);
  }
  before.forces.clear();
  before.load = {};
  EvolutionPolicy evolution;
  evolution.lambda = stroke.lambda;
  evolution.accuracy = act.state.evolution.accuracy;
  const auto model = act.cache.models.of(before, evolution);
  if (!model) return std::unexpected(model.error());
  const auto loads = (*model)->loads(before);
  if (!loads) return std::unexpected(loads.error());
  ActiveState from = active_state(before);
  from.balanced = true;
  from.guess = std::move(guess);
  auto step = (*model)->step(from, tools, *loads);
  if (step) step->control_points -= from.control_points;  // the displacement
  return step;
}

/// The displacement of a place of a stroke, made again where it goes further than these tools stand
/// in the shapes from before the stroke: beside what is held inside a tool a surface swings out,
/// far beyond the tool where that is large.
/// Measured at the abscissae first, which are known, and only if that is exceeded on the surface.
Expected<ActiveStep> within_depth(const Act& act, ActiveStep step, const ActiveState& from,
                                  std::span<const Tool> tools, ActiveLoads loads) {
  const StrokeModel& model = *act.cache.stroke;
  if (loads.limit > 0 || !held_all_round(act.state, seams_in_scene(model.scene.seams, act.state)))
    return step;
  const double room = 1 + 0.5 * law_tolerance;
  const double moved =
      std::sqrt(model.at_abscissae(step.control_points).rowwise().squaredNorm().maxCoeff());
  if (moved <= room * model.depth_of(tools)) return step;
  const double depth = depth_in_shapes(act.state.stroke->before, tools);
  if (moved <= room * depth) return step;
  loads.reach = depth;
  loads.original = from.control_points;
  auto shorter = model.scene.model.step(from, tools, loads);
  if (shorter) shorter->control_points -= from.control_points;
  return shorter;
}

}  // namespace

Expected<ActiveStep> press(Act& act, std::vector<Tool> tools, std::span<const Travel> travels) {
  if (auto made = prepare_stroke_model(act); !made) return std::unexpected(made.error());
  const OpenStroke& stroke = *act.state.stroke;
  for (Tool& tool : tools) harden(tool, stroke);
  if (has_shells(act.state))
    return press_shell_on_bed(act, tools,
                              act.cache.stroke->after_travels(stroke.before, stroke.last, travels));
  const ActiveSurface& model = act.cache.stroke->scene.model;
  auto loads = active_loads(act.state, act.cache.stroke->scene);
  if (!loads) return std::unexpected(loads.error());
  ActiveState from{stacked(stroke.before, &OpenStroke::Before::current),
                   stacked(stroke.before, &OpenStroke::Before::rest)};
  auto anchored = anchors(act.state, model, from.control_points);
  if (!anchored) return std::unexpected(anchored.error());
  loads->points = std::move(*anchored);  // other forces are in balance with the shape as it was
  from.balanced = true;
  from.guess = act.cache.stroke->after_travels(stroke.before, stroke.last, travels);
  auto step = model.step(from, tools, *loads);
  if (step) step->control_points -= from.control_points;  // the displacement
  if (step) step = within_depth(act, std::move(*step), from, tools, *loads);
  return step;
}

}  // namespace knead
