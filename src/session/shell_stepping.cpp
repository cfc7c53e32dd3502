#include <algorithm>
#include <chrono>

#include "executor.hpp"
#include "knead/solve/shell_statics.hpp"
#include "scene/shell_model.hpp"

namespace knead {

Expected<void> Executor::run_shell(const EvolutionPolicy& evolution) {
  if (evolution.mode != Evolution::stationary) {
    return input_error("a shell has static steps only", "evolve", R"(use {"do":"evolve","mode":"static"})");
  }
  SceneSurface& s = state.surfaces[static_cast<std::size_t>(*state.selected)];
  const auto start = std::chrono::steady_clock::now();
  const auto problem = shell_problem(state);
  if (!problem) return std::unexpected(problem.error());
  const Points &rest = s.rest->control_points(), &present = s.current->control_points();
  if (!state.energy_before) state.energy_before = problem->energy.energy(present).sum();
  auto found = shell_equilibrium(problem->energy, rest, problem->constraints, problem->load,
                                 {.increments = increments.value_or(1)}, problem->moments);
  if (!found) return std::unexpected(found.error());
  ActiveStep step;
  step.control_points = with_held_bits(*problem, rest, present, std::move(found->control_points));
  const ShellParts energy = problem->energy.energy(step.control_points);
  step.stretch = energy.membrane;
  step.bend = energy.bending;
  step.energy = energy.sum();
  step.converged = found->converged;
  std::vector<int> iterations;
  for (const ShellIncrement& part : found->increments) {
    iterations.push_back(part.iterations);
    step.iterations += part.iterations;
    step.residual = part.residual;
  }
  if (auto taken = take(step); !taken) return taken;
  if (auto sound = check_folds(); !sound) return sound;
  record(step, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), found->note);
  state.steps.back().load_factor = found->load_factor;
  state.steps.back().increments = std::move(iterations);
  state.seam_reports.clear();
  for (const std::string& note : problem->notes) {
    if (std::ranges::find(state.notes, note) == state.notes.end()) state.notes.push_back(note);
  }
  return {};
}

}  // namespace knead
