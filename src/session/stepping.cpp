#include "stepping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "following.hpp"
#include "holding.hpp"
#include "knead/base/error_code.hpp"
#include "knead/base/interruption.hpp"
#include "knead/scene/followed.hpp"
#include "knead/spline/extremum.hpp"
#include "notes.hpp"
#include "refining.hpp"
#include "scene/anchors.hpp"
#include "scene/model/shell_model.hpp"
#include "selection.hpp"
#include "trimming.hpp"

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

namespace {

bool keeps_steps(Act& act, int done) {
  if (!act.may_stop || done == 0) return false;
  act.stopped = done;
  Interruption::settle();
  return true;
}

}  // namespace

Expected<bool> carries_on(Act& act, int done, int total) {
  if (Interruption::asked_for()) {
    if (!keeps_steps(act, done)) return interrupted_error();
    return false;
  }
  if (!act.progress || act.progress(done, total) || done >= total) return true;
  if (!act.may_stop) return input_error(fmt::format("it was stopped after {} of {} steps", done, total));
  act.stopped = done;
  return false;
}

namespace {

Expected<void> know_what_holds(Act& act) {
  if (auto known = know_trims(act); !known) return known;
  return know_followed(act);
}

Expected<ActiveStep> next_step(Act& act, const EvolutionPolicy& evolution, const std::vector<PointForce>& more,
                               double& seconds) {
  if (auto known = know_what_holds(act); !known) return std::unexpected(known.error());
  const auto kept = act.cache.models.of(act.state, evolution);
  if (!kept) return std::unexpected(kept.error());
  Model& model = **kept;
  const auto tools = tools_and_images(act.state);
  if (!tools) return std::unexpected(tools.error());
  auto loads = model.loads(act.state, more);
  if (!loads) return std::unexpected(loads.error());
  const ActiveState before = active_state(act.state);
  if (!act.state.energy_before) act.state.energy_before = model.energy(before);
  const auto start = std::chrono::steady_clock::now();
  auto step = model.step(before, *tools, *loads, act.increments.value_or(1));
  if (step && goes_too_far(act, *step, *loads, model)) {
    loads->reach = act.law->reach;
    loads->original = points_of_law(act);
    step = model.step(before, *tools, *loads);
  }
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return step;
}

Expected<void> check_limit(const Scene& scene) {
  constexpr double tolerance = 1e-5;  // of the limit; steps keep it to 1e-6
  if (!scene.limit) return {};
  for (int index : scene.selection()) {
    const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(index)];
    const double largest = largest_distance(*s.current, *s.opened);
    if (largest <= *scene.limit * (1 + tolerance)) continue;
    return numerical_error(
        fmt::format("the step leads {:.6g} away from the surface as opened, beyond the limit of {:.6g}", largest,
                    *scene.limit),
        s.id, "refine the net, soften or move the tool, or set a larger limit");
  }
  return {};
}

Expected<void> run_body(Act& act, int count, const EvolutionPolicy& evolution) {
  for (int k = 0; k < count; ++k) {
    double seconds = 0;
    const auto step = next_step(act, evolution, {}, seconds);
    if (!step && Interruption::asked_for() && keeps_steps(act, k)) break;
    if (!step) return std::unexpected(step.error());
    if (!std::isfinite(step->energy) || !std::isfinite(step->residual)) return beyond_numbers();
    if (auto taken = take(act, *step); !taken) return taken;
    record(act, *step, seconds, note_of(*step));
    for (const std::string& note : act.cache.models.last()->notes()) note_once(act.state, note);
    const auto on = carries_on(act, k + 1, count);
    if (!on) return std::unexpected(on.error());
    if (!*on) break;
  }
  return {};
}

}  // namespace

/// Notes where tools press on what nothing holds: it moves as a whole.
void note_loose(Act& act) {
  if (!act.law || act.unruled || !(act.law->reach > 0)) return;
  std::string loose;
  std::vector<std::string> ids;
  for (const int k : act.state.selection()) {
    const SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(k)];
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
  note_once(act.state, std::move(note));
}

namespace {

/// Whether what the tools have done becomes the rest shape.
bool imprints(const Act& act, const ActiveStep& step) {
  return step.gap > 0 &&
         std::ranges::any_of(act.state.tools, [](const Tool& t) { return t.mode == ToolMode::imprint; });
}

}  // namespace

Expected<void> take(Act& act, const ActiveStep& step) {
  Eigen::Index first = 0;
  const bool imprinting = imprints(act, step);
  return each_selected(act, [&]<int D>(SceneShape<D>& s) -> Expected<void> {
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

void record(Act& act, const ActiveStep& step, double seconds, std::string note) {
  StepRecord record = record_of(step, seconds, std::move(note));
  record.surface = act.state.selected.value_or(-1);
  if (act.state.body) record.largest_displacement = largest_displacement(*body(act));
  for (int index : act.state.selection()) {
    const SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(index)];
    record.largest_displacement = std::max(record.largest_displacement, largest_distance(*s.current, *s.opened));
  }
  act.state.steps.push_back(std::move(record));
}

void note_model(Act& act, std::span<const SeamReport> seams, std::span<const std::string> notes) {
  act.state.seam_reports.assign(seams.begin(), seams.end());
  const std::vector<int> selection = act.state.selection();
  for (SeamReport& report : act.state.seam_reports) {
    for (PatchEdge* edge : {&report.seam.a, &report.seam.b}) {
      edge->patch = selection[static_cast<std::size_t>(edge->patch)];
    }
  }
  for (const std::string& note : notes) note_once(act.state, note);
  note_creases(act, seams);
}

Expected<void> yield(Act& act, double plasticity) {
  if (plasticity == 0) return {};
  for (int index : act.state.selection()) {
    SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(index)];
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

Expected<void> run(Act& act, int count, const EvolutionPolicy& evolution, const std::vector<PointForce>& more, int done,
                   int total) {
  if (act.state.body) return run_body(act, count, evolution);
  auto selection = selected(act);
  if (!selection) return std::unexpected(selection.error());
  if (act.increments && !has_shells(act.state)) {
    return input_error("only the load of a shell is increased in parts", "increments",
                       R"(leave it out, or give {"do":"material","model":"shell"} with young and thickness)",
                       {ErrorCode::shell_needed});
  }
  if (act.state.permission == RefinePermission::automatic) {
    if (auto refined = refine_seams(act); !refined) return refined;
  }
  if (auto refined = refine_trims(act); !refined) return refined;
  if (auto united = unite_followed(act); !united) return united;
  int refinements = 0, stepped = 0;
  act.at_fold = false;
  std::optional<Attempts> tried;
  while (stepped < count) {
    double seconds = 0;
    if (stepped == 0) {
      if (auto known = know_what_holds(act); !known) return known;
      if (auto asked = ask_of_motion(act, evolution, more); !asked) return asked;
      note_loose(act);
    }
    const auto step = next_step(act, evolution, more, seconds);
    if (!step && Interruption::asked_for() && keeps_steps(act, stepped)) break;
    if (!step) return std::unexpected(step.error());
    if (!std::isfinite(step->energy) || !std::isfinite(step->residual)) return beyond_numbers();
    if (step->coarseness > coarse && act.state.permission == RefinePermission::automatic &&
        refinements < max_refinements && more.empty()) {
      bool any = false;
      for (const Tool& tool : act.state.tools) {
        auto refined = refine_under(act, tool, true);
        if (!refined) return std::unexpected(refined.error());
        any = any || *refined;
      }
      if (any) {  // this step again, on the finer net
        ++refinements;
        continue;
      }
    }
    std::string note = note_of(*step);
    if (!act.allow_held && more.empty() && step->gap > 0 && nothing_moved(act.state, *step)) {
      const Error error = all_held(act.state, step->gap_tool);
      if (holds_edges(act.state)) return std::unexpected(error);
      note = error.what + "; " + error.remedy;  // requested, row by row or point by point: reported, not refused
    }
    if (!tried) tried = attempts(act);
    const auto taken = take_together(act, *step, *tried);
    if (!taken) return std::unexpected(taken.error());
    if (!*taken) continue;
    const auto smaller = keep_step_unfolded(act, tried->before, done + stepped == 0, evolution);
    if (!smaller) return std::unexpected(smaller.error());
    if (!smaller->empty()) note = *smaller;
    if (act.through == Through::stop) {  // as equal steps that are one command, and as many
      act.met_at_each_step = true;
      if (auto stops = meet_faces(act, tried->before); !stops) return stops;
    }
    tried.reset();
    if (auto within = check_limit(act.state); !within) return within;
    record(act, *step, seconds, std::move(note));
    ++stepped;
    if (act.at_fold) break;
    const auto on = carries_on(act, done + stepped, total > 0 ? total : count);
    if (!on) return std::unexpected(on.error());
    if (!*on) break;
  }
  if (const Model* model = act.cache.models.last(); stepped > 0 && model != nullptr)
    note_model(act, model->seams(), model->notes());
  return {};
}

}  // namespace knead
