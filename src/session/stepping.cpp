#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "executor.hpp"
#include "knead/base/error_code.hpp"
#include "knead/base/interruption.hpp"
#include "knead/scene/followed.hpp"
#include "knead/spline/extremum.hpp"
#include "scene/anchors.hpp"

namespace knead {
namespace {

/// Whether the step left every selected surface at rest and as opened.
bool nothing_moved(const Scene& scene, const ActiveStep& step) {
  Eigen::Index first = 0;
  for (int index : scene.selection()) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(index)];
    const Eigen::Index n = s.current->size();
    if (s.mode == RestMode::none || s.current != s.rest || s.current != s.opened) return false;
    if (step.control_points.middleRows(first, n) != s.current->control_points()) return false;
    first += n;
  }
  return true;
}

}  // namespace

std::unexpected<Error> beyond_numbers() {
  return numerical_error("the forces, or the energy, exceed what numbers can hold", {},
                         "use smaller loads and stiffnesses, or lengths nearer to 1");
}

std::string note_of(const ActiveStep& step) {
  constexpr double too_coarse = 1;  // spans longer than this share of a tool cannot follow it
  if (!step.note.empty() || step.coarseness <= too_coarse) return step.note;
  const int halvings = static_cast<int>(std::ceil(std::log2(step.coarseness / coarse)));
  return fmt::format(
      "the net is too coarse to follow the tool: its spans are up to {:.2g} times the tool's size; "
      "halve them {} with {{\"do\":\"refine\",\"under\":\"…\"}}",
      step.coarseness, halvings == 1 ? "once" : fmt::format("{} times", halvings));
}

Expected<bool> Executor::carries_on(int done, int total) {
  if (Interruption::asked_for()) {
    if (!keeps_steps(done)) return interrupted_error();
    return false;
  }
  if (!progress || progress(done, total) || done >= total) return true;
  if (!may_stop) return input_error(fmt::format("it was stopped after {} of {} steps", done, total));
  stopped = done;
  return false;
}

bool Executor::keeps_steps(int done) {
  if (!may_stop || done == 0) return false;
  stopped = done;
  Interruption::settle();
  return true;
}

Expected<ActiveStep> Executor::next_step(const EvolutionPolicy& evolution, const std::vector<PointForce>& more,
                                         double& seconds) {
  if (auto known = know_what_holds(); !known) return std::unexpected(known.error());
  const auto kept = models.of(state, evolution);
  if (!kept) return std::unexpected(kept.error());
  Model& model = **kept;
  const auto tools = tools_and_images(state);
  if (!tools) return std::unexpected(tools.error());
  auto loads = model.loads(state, more);
  if (!loads) return std::unexpected(loads.error());
  const ActiveState before = active_state(state);
  if (!state.energy_before) state.energy_before = model.energy(before);
  const auto start = std::chrono::steady_clock::now();
  auto step = model.step(before, *tools, *loads, increments.value_or(1));
  if (step && goes_too_far(*step, *loads, model)) {
    loads->reach = law->reach;
    loads->original = points_of_law();
    step = model.step(before, *tools, *loads);
  }
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return step;
}

Expected<void> Executor::run(int count, const EvolutionPolicy& evolution, const std::vector<PointForce>& more, int done,
                             int total) {
  if (state.body) return run_body(count, evolution);
  auto selection = selected();
  if (!selection) return std::unexpected(selection.error());
  if (increments && !shells()) {
    return input_error("only the load of a shell is increased in parts", "increments",
                       R"(leave it out, or give {"do":"material","model":"shell"} with young and thickness)",
                       {ErrorCode::shell_needed});
  }
  if (state.permission == RefinePermission::automatic) {
    if (auto refined = refine_seams(); !refined) return refined;
  }
  if (auto refined = refine_trims(); !refined) return refined;
  if (auto united = unite_followed(); !united) return united;
  int refinements = 0, stepped = 0;
  at_fold = false;
  std::optional<Attempts> tried;
  while (stepped < count) {
    double seconds = 0;
    if (stepped == 0) {
      if (auto known = know_what_holds(); !known) return known;
      if (auto asked = ask_of_motion(evolution, more); !asked) return asked;
      note_loose();
    }
    const auto step = next_step(evolution, more, seconds);
    if (!step && Interruption::asked_for() && keeps_steps(stepped)) break;
    if (!step) return std::unexpected(step.error());
    if (!std::isfinite(step->energy) || !std::isfinite(step->residual)) return beyond_numbers();
    if (step->coarseness > coarse && state.permission == RefinePermission::automatic && refinements < max_refinements &&
        more.empty()) {
      bool any = false;
      for (const Tool& tool : state.tools) {
        auto refined = refine_under(tool, true);
        if (!refined) return std::unexpected(refined.error());
        any = any || *refined;
      }
      if (any) {  // this step again, on the finer net
        ++refinements;
        continue;
      }
    }
    std::string note = note_of(*step);
    if (!allow_held && more.empty() && step->gap > 0 && nothing_moved(state, *step)) {
      const Error error = all_held(step->gap_tool);
      if (holds_edges()) return std::unexpected(error);
      note = error.what + "; " + error.remedy;  // requested, row by row or point by point: reported, not refused
    }
    if (!tried) tried = attempts();
    const auto taken = take_together(*step, *tried);
    if (!taken) return std::unexpected(taken.error());
    if (!*taken) continue;
    const auto smaller = keep_step_unfolded(tried->before, done + stepped == 0, evolution);
    if (!smaller) return std::unexpected(smaller.error());
    if (!smaller->empty()) note = *smaller;
    if (through == Through::stop) {  // as equal steps that are one command, and as many
      met_at_each_step = true;
      if (auto stops = meet_faces(tried->before); !stops) return stops;
    }
    tried.reset();
    if (auto within = check_limit(); !within) return within;
    record(*step, seconds, std::move(note));
    ++stepped;
    if (at_fold) break;
    const auto on = carries_on(done + stepped, total > 0 ? total : count);
    if (!on) return std::unexpected(on.error());
    if (!*on) break;
  }
  if (const Model* model = models.last(); stepped > 0 && model != nullptr) note_model(model->seams(), model->notes());
  return {};
}

Expected<void> Executor::run_body(int count, const EvolutionPolicy& evolution) {
  for (int k = 0; k < count; ++k) {
    double seconds = 0;
    const auto step = next_step(evolution, {}, seconds);
    if (!step && Interruption::asked_for() && keeps_steps(k)) break;
    if (!step) return std::unexpected(step.error());
    if (!std::isfinite(step->energy) || !std::isfinite(step->residual)) return beyond_numbers();
    if (auto taken = take(*step); !taken) return taken;
    record(*step, seconds, note_of(*step));
    note_all(models.last()->notes());
    const auto on = carries_on(k + 1, count);
    if (!on) return std::unexpected(on.error());
    if (!*on) break;
  }
  return {};
}

/// Notes where tools press on what nothing holds: it moves as a whole.
void Executor::note_loose() {
  if (!law || unruled || !(law->reach > 0)) return;
  std::string loose;
  std::vector<std::string> ids;
  for (const int k : state.selection()) {
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(k)];
    if (holds_anything(s)) return;
    loose += (loose.empty() ? "" : ", ") + s.id;
    ids.push_back(s.id);
  }
  Note note(fmt::format("nothing holds {}: what presses on it moves all of it; hold its edges, "
                        "{{\"do\":\"hold\",\"mode\":\"trim\"}}, or "
                        "its "
                        "outer rows, {{\"do\":\"hold\",\"rows\":2}}",
                        loose),
            {ErrorCode::surface_loose, {{"surfaces", ids}}});
  if (std::ranges::find(state.notes, note) == state.notes.end()) state.notes.push_back(std::move(note));
}

Expected<void> Executor::check_limit() const {
  constexpr double tolerance = 1e-5;  // of the limit; steps keep it to 1e-6
  if (!state.limit) return {};
  for (int index : state.selection()) {
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(index)];
    const double largest = largest_distance(*s.current, *s.opened);
    if (largest <= *state.limit * (1 + tolerance)) continue;
    return numerical_error(
        fmt::format("the step leads {:.6g} away from the surface as opened, beyond the limit of {:.6g}", largest,
                    *state.limit),
        s.id, "refine the net, soften or move the tool, or set a larger limit");
  }
  return {};
}

Expected<void> Executor::know_what_holds() {
  if (auto known = know_trims(); !known) return known;
  return know_followed();
}

/// Whether what the tools have done becomes the rest shape.
bool Executor::imprints(const ActiveStep& step) const {
  return step.gap > 0 && std::ranges::any_of(state.tools, [](const Tool& t) { return t.mode == ToolMode::imprint; });
}

Expected<void> Executor::take(const ActiveStep& step) {
  Eigen::Index first = 0;
  const bool imprinting = imprints(step);
  return each_selected([&]<int D>(SceneShape<D>& s) -> Expected<void> {
    const Eigen::Index n = s.current->size();
    auto moved = s.current->with_control_points(step.control_points.middleRows(first, n));
    if (!moved) return std::unexpected(moved.error());
    if (moved->control_points() != s.current->control_points()) {
      s.current = std::make_shared<const Spline<D>>(*std::move(moved));
    }
    s.velocity = step.velocity.rows() > 0 ? Points(step.velocity.middleRows(first, n)) : Points(0, 3);
    if (imprinting) s.rest = s.current;
    first += n;
    return {};
  });
}

StepRecord record_of(const ActiveStep& step, double seconds, std::string note) {
  StepRecord record;
  record.time = seconds;
  record.energy = step.energy;
  record.stretch = step.stretch;
  record.bend = step.bend;
  record.kinetic = step.kinetic;
  record.contact = step.contact;
  record.residual = step.residual;
  record.gap = step.gap;
  record.violation = step.violation;
  record.iterations = step.iterations;
  record.converged = step.converged;
  record.limited = step.limited;
  record.energy_error = step.energy_error;
  record.load_factor = step.load_factor;
  record.increments = step.increments;
  record.note = std::move(note);
  return record;
}

void Executor::record(const ActiveStep& step, double seconds, std::string note) {
  StepRecord record = record_of(step, seconds, std::move(note));
  record.surface = state.selected.value_or(-1);
  if (state.body) record.largest_displacement = largest_displacement(*body());
  for (int index : state.selection()) {
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(index)];
    record.largest_displacement = std::max(record.largest_displacement, largest_distance(*s.current, *s.opened));
  }
  state.steps.push_back(std::move(record));
}

void Executor::note_model(std::span<const SeamReport> seams, std::span<const std::string> notes) {
  state.seam_reports.assign(seams.begin(), seams.end());
  const std::vector<int> selection = state.selection();
  for (SeamReport& report : state.seam_reports) {
    for (PatchEdge* edge : {&report.seam.a, &report.seam.b}) {
      edge->patch = selection[static_cast<std::size_t>(edge->patch)];
    }
  }
  note_all(notes);
  note_creases(seams);
}

void Executor::note_all(std::span<const std::string> notes) {
  for (const std::string& note : notes) {
    if (std::ranges::find(state.notes, note) == state.notes.end()) state.notes.push_back(note);
  }
}

Expected<void> Executor::yield(double plasticity) {
  if (plasticity == 0) return {};
  for (int index : state.selection()) {
    SceneSurface& s = state.surfaces[static_cast<std::size_t>(index)];
    if (plasticity == 1) {
      s.rest = s.current;
      continue;
    }
    auto rest = s.rest->with_control_points(s.rest->control_points() +
                                            plasticity * (s.current->control_points() - s.rest->control_points()));
    if (!rest) return std::unexpected(rest.error());
    s.rest = std::make_shared<const Surface>(std::move(*rest));
  }
  return {};
}

}  // namespace knead
