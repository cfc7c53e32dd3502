#include <algorithm>
#include <cmath>

#include "executor.hpp"
#include "knead/base/interruption.hpp"

namespace knead {

SceneBody* Executor::body() { return state.body ? &state.bodies[static_cast<std::size_t>(*state.body)] : nullptr; }

/// Whether what the tools have done becomes the rest shape.
bool Executor::imprints(const ActiveStep& step) const {
  return step.gap > 0 && std::ranges::any_of(state.tools, [](const Tool& t) { return t.mode == ToolMode::imprint; });
}

Expected<void> Executor::take_body(const ActiveStep& step) {
  body()->velocity = step.velocity.rows() > 0 ? step.velocity : Points(0, 3);
  return std::visit(
      [&]<int D>(BodyShapes<D>& shapes) -> Expected<void> {
        auto moved = shapes.current->with_control_points(step.control_points);
        if (!moved) return std::unexpected(moved.error());
        if (moved->control_points() != shapes.current->control_points()) {
          shapes.current = std::make_shared<const Spline<D>>(*std::move(moved));
        }
        if (imprints(step)) shapes.rest = shapes.current;
        return {};
      },
      body()->shapes);
}

/// Keeps the record of a step of the selected body, and notes on its model that are new.
void Executor::record_body(const ActiveStep& step, double seconds, std::span<const std::string> notes) {
  StepRecord record = record_of(step, seconds, note_of(step));
  record.surface = -1;
  record.largest_displacement = largest_displacement(*body());
  state.steps.push_back(std::move(record));
  for (const std::string& note : notes) {
    if (std::ranges::find(state.notes, note) == state.notes.end()) state.notes.push_back(note);
  }
}

Expected<void> Executor::run_body(int count, const EvolutionPolicy& evolution) {
  for (int k = 0; k < count; ++k) {
    double seconds = 0;
    const auto step = next_step(evolution, {}, seconds);
    if (!step && Interruption::asked_for() && keeps_steps(k)) break;
    if (!step) return std::unexpected(step.error());
    if (!std::isfinite(step->energy) || !std::isfinite(step->residual)) return beyond_numbers();
    if (auto taken = take_body(*step); !taken) return taken;
    record_body(*step, seconds, models.last()->notes());
    const auto on = carries_on(k + 1, count);
    if (!on) return std::unexpected(on.error());
    if (!*on) break;
  }
  return {};
}

}  // namespace knead
