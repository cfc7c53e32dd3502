#include <algorithm>
#include <chrono>
#include <cmath>

#include "executor.hpp"
#include "knead/base/interruption.hpp"
#include "knead/scene/body_model.hpp"

namespace knead {
namespace {

template <int D>
Expected<void> take_body(SceneBody& body, BodyShapes<D>& shapes, const ActiveStep& step, bool imprinting) {
  auto moved = shapes.current->with_control_points(step.control_points);
  if (!moved) return std::unexpected(moved.error());
  if (moved->control_points() != shapes.current->control_points()) {
    shapes.current = std::make_shared<const Spline<D>>(*std::move(moved));
  }
  body.velocity = step.velocity.rows() > 0 ? step.velocity : Points(0, 3);
  if (imprinting) shapes.rest = shapes.current;
  return {};
}

}  // namespace

SceneBody* Executor::body() { return state.body ? &state.bodies[static_cast<std::size_t>(*state.body)] : nullptr; }

/// Whether what the tools have done becomes the rest shape.
bool Executor::imprints(const ActiveStep& step) const {
  return step.gap > 0 && std::ranges::any_of(state.tools, [](const Tool& t) { return t.mode == ToolMode::imprint; });
}

/// A step of a body that keeps its fundamental forms.
template <int D>
Expected<void> Executor::settle_body(BodyShapes<D>& shapes, const EvolutionPolicy& evolution) {
  SceneBody& b = *body();
  if (!state.energy_before) {
    const auto before = form_energy_of(b);
    if (!before) return std::unexpected(before.error());
    state.energy_before = *before;
  }
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::string> notes;
  const auto step = settle_forms(state, *state.body, evolution, notes);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!step) return std::unexpected(step.error());
  if (!std::isfinite(step->energy) || !std::isfinite(step->residual)) return beyond_numbers();
  if (auto done = take_body(b, shapes, *step, imprints(*step)); !done) return done;
  record_body(*step, seconds, notes);
  return {};
}

/// Keeps the record of a step of the selected body, and notes on its model that are new.
void Executor::record_body(const ActiveStep& step, double seconds, const std::vector<std::string>& notes) {
  StepRecord record = record_of(step, seconds, note_of(step));
  record.surface = -1;
  record.largest_displacement = largest_displacement(*body());
  state.steps.push_back(std::move(record));
  for (const std::string& note : notes) {
    if (std::ranges::find(state.notes, note) == state.notes.end()) state.notes.push_back(note);
  }
}

template <int D>
Expected<void> Executor::step_body(BodyShapes<D>& shapes, const EvolutionPolicy& evolution) {
  SceneBody& b = *body();
  if (is_nonlinear(shapes.elasticity)) return settle_body(shapes, evolution);
  BodyInput<D> input = body_input<D>(state, b, evolution);
  const auto* known = body_cache ? std::get_if<BodyModel<D>>(&*body_cache) : nullptr;
  if (known == nullptr || !(known->input == input)) {
    body_cache.reset();
    auto made = make_body_model<D>(std::move(input));
    if (!made) return std::unexpected(made.error());
    body_cache.emplace(*std::move(made));
  }
  const auto& [made_for, model, notes] = std::get<BodyModel<D>>(*body_cache);
  const auto loads = body_loads(state, *state.body);
  if (!loads) return std::unexpected(loads.error());
  const ActiveState before = active_state(b);
  if (!state.energy_before) state.energy_before = model.energy(before);
  const auto start = std::chrono::steady_clock::now();
  const auto step = model.step(before, state.tools, *loads);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!step) return std::unexpected(step.error());
  if (!std::isfinite(step->energy) || !std::isfinite(step->residual)) return beyond_numbers();
  if (auto done = take_body(b, shapes, *step, imprints(*step)); !done) return done;
  record_body(*step, seconds, notes);
  return {};
}

Expected<void> Executor::run_body(int count, const EvolutionPolicy& evolution) {
  for (int k = 0; k < count; ++k) {
    auto done = std::visit([&](auto& shapes) { return step_body(shapes, evolution); }, body()->shapes);
    if (!done && Interruption::asked_for() && keeps_steps(k)) break;
    if (!done) return done;
    const auto on = carries_on(k + 1, count);
    if (!on) return std::unexpected(on.error());
    if (!*on) break;
  }
  return {};
}

}  // namespace knead
