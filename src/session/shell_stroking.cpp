#include "executor.hpp"
#include "scene/model/shell_model.hpp"

namespace knead {

bool Executor::shells() const { return has_shells(state); }

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
  const auto model = models.of(before, evolution);
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

}  // namespace knead
