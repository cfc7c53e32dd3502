#include <algorithm>
#include <chrono>

#include "executor.hpp"
#include "knead/scene/anchors.hpp"
#include "knead/solve/shell_statics.hpp"

namespace knead {

bool Executor::shells() const {
  return std::ranges::any_of(
      state.selection(), [&](int k) { return is_nonlinear(state.surfaces[static_cast<std::size_t>(k)].elasticity); });
}

Expected<ActiveStep> Executor::one_shell_step(const EvolutionPolicy& evolution, const std::vector<PointForce>& more,
                                              double& seconds) {
  const auto start = std::chrono::steady_clock::now();
  auto problem = shell_problem(state, kept_shell_problem());
  if (!problem) return std::unexpected(problem.error());
  if (!state.energy_before) state.energy_before = problem->structure.energy(problem->present).sum();
  auto step = evolution.mode == Evolution::stationary && more.empty() && !touches_shell(state)
                  ? load_shell(*problem)
                  : press_shell(*problem, evolution, more);
  if (!step) return step;
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  shell_seams = std::move(problem->joined.seams);
  shell_notes = std::move(problem->joined.notes);
  return step;
}

/// Equilibrium under dead loads and moments, which need not be stable, from the rest shape.
Expected<ActiveStep> Executor::load_shell(const ShellProblem& problem) {
  auto found = shell_equilibrium(problem.structure, problem.rest, problem.constraints, problem.load,
                                 {.increments = increments.value_or(1)}, problem.moments);
  if (!found) return std::unexpected(found.error());
  ActiveStep step;
  step.control_points =
      with_held_bits(std::move(found->control_points), problem.present, problem.rest, problem.constraints);
  const ShellParts energy = problem.structure.energy(step.control_points);
  step.stretch = energy.membrane;
  step.bend = energy.bending;
  step.energy = energy.sum();
  step.converged = found->converged;
  step.note = found->note;
  step.load_factor = found->load_factor;
  for (const ShellIncrement& part : found->increments) {
    step.increments.push_back(part.iterations);
    step.iterations += part.iterations;
    step.residual = part.residual;
  }
  return step;
}

const ShellProblem* Executor::kept_shell_problem() const { return shell_cache ? &shell_cache->problem : nullptr; }

/// Sees to it that the kept model is this one.
Expected<void> Executor::keep_shell(const Scene& scene, const ShellProblem& problem, const EvolutionPolicy& evolution) {
  if (shell_cache && shell_cache->serves(problem, evolution)) return {};
  shell_cache.reset();
  auto made = make_shell_model(scene, problem, evolution);
  if (!made) return std::unexpected(made.error());
  shell_cache = std::move(*made);
  return {};
}

/// A step under tools, or in time.
Expected<ActiveStep> Executor::press_shell(const ShellProblem& problem, const EvolutionPolicy& evolution,
                                           const std::vector<PointForce>& more) {
  if (auto kept = keep_shell(state, problem, evolution); !kept) return std::unexpected(kept.error());
  const auto tools = tools_and_images(state);
  if (!tools) return std::unexpected(tools.error());
  const int parts = evolution.mode == Evolution::stationary ? increments.value_or(1) : 1;
  ActiveState from = active_state(state);
  const auto anchored = shell_anchors(state, from.control_points);
  if (!anchored) return std::unexpected(anchored.error());
  ActiveStep step;
  std::vector<int> iterations;
  for (int part = 1; part <= parts; ++part) {
    auto loads = shell_loads(state, problem, static_cast<double>(part) / parts);
    if (!loads) return std::unexpected(loads.error());
    loads->points.insert(loads->points.end(), more.begin(), more.end());
    loads->points.insert(loads->points.end(), anchored->begin(), anchored->end());
    auto taken = shell_cache->model.step(from, *tools, *loads);
    if (!taken) return taken;
    iterations.push_back(taken->iterations);
    from.control_points = taken->control_points;
    step = std::move(*taken);
  }
  step.control_points =
      with_held_bits(std::move(step.control_points), problem.present, problem.rest, problem.constraints);
  if (evolution.mode == Evolution::stationary) {
    step.load_factor = 1;
    step.increments = std::move(iterations);
  }
  return step;
}

}  // namespace knead
