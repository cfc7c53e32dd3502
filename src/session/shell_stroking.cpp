#include "executor.hpp"
#include "knead/scene/anchors.hpp"

namespace knead {

/// What the tools of the open stroke ask of shells, on the stroke's bed. The shapes from before the stroke are those of
/// no stress here: what they carry is in balance with the forces on them, which are therefore left out.
Expected<ActiveStep> Executor::press_shell_on_bed(const std::vector<Tool>& tools, Points guess) {
  const OpenStroke& stroke = *state.stroke;
  Scene before = state;
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
  evolution.accuracy = state.evolution.accuracy;
  const auto problem = shell_problem(before, kept_shell_problem());
  if (!problem) return std::unexpected(problem.error());
  if (auto kept = keep_shell(before, *problem, evolution); !kept) return std::unexpected(kept.error());
  auto loads = shell_loads(before, *problem, 1);
  if (!loads) return std::unexpected(loads.error());
  ActiveState from = active_state(before);
  const auto anchored = shell_anchors(before, from.control_points);
  if (!anchored) return std::unexpected(anchored.error());
  loads->points.insert(loads->points.end(), anchored->begin(), anchored->end());
  from.guess = std::move(guess);
  auto step = shell_cache->model.step(from, tools, *loads);
  if (step) step->control_points -= from.control_points;  // the displacement
  return step;
}

}  // namespace knead
