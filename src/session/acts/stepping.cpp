#include "stepping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/interruption.hpp"
#include "following.hpp"
#include "holding.hpp"
#include "knead/base/error_code.hpp"
#include "knead/spline/extremum.hpp"
#include "notes.hpp"
#include "refining.hpp"
#include "scene/anchors.hpp"
#include "scene/followed.hpp"
#include "scene/model/shell_model.hpp"
#include "selection.hpp"
#include "trimming.hpp"

namespace knead {
namespace {

/// Whether the step left every selected surface at rest and as opened.
bool nothing_moved(const Scene& scene, const ActiveStep& step) {
  Eigen::Index first = 0;
  for (const SceneSurface& s : selected_surfaces(scene)) {
    const Eigen::Index n = s.current->size();
    if (s.mode == RestMode::none || s.current != s.rest || s.current != s.opened) return false;
    if (step.control_points.middleRows(first, n) != s.current->control_points()) return false;
    first += n;
  }
  return true;
}

std::unexpected<Error> beyond_numbers() {
  return numerical_error("the forces, or the energy, exceed what numbers can hold", {},
                         "use smaller loads and stiffnesses, or lengths nearer to 1");
}

}  // namespace

std::string note_of(const ActiveStep& step) {
  constexpr double too_coarse = 1;  // spans longer than this share of a tool cannot follow it
  if (!step.note.empty() || step.coarseness <= too_coarse) return step.note;
  const int halvings = static_cast<int>(std::ceil(std::log2(step.coarseness / coarse)));
  return fmt::format(
      "the net is too coarse to follow the tool: its spans are up to {:.2g} times the tool's size; "
      "halve them {} with {{\"do\":\"refine\",\"under\":\"…\"}}",
      step.coarseness, halvings == 1 ? "once" : fmt::format("{} times", halvings));
}

Expected<void> tell_progress(const Act& act, int steps, int of) {
  if (Interruption::asked_for()) return interrupted_error();
  if (!act.progress || act.progress(steps, of) || steps >= of) return {};
  return input_error(fmt::format("it was stopped after {} of {} steps", steps, of));
}

namespace {

Expected<void> know_what_holds(Act& act) {
  if (auto known = know_trims(act); !known) return known;
  return know_followed(act);
}

Expected<void> check_limit(const Scene& scene) {
  constexpr double tolerance = 1e-5;  // of the limit; steps keep it to 1e-6
  if (!scene.limit) return {};
  for (const SceneSurface& s : selected_surfaces(scene)) {
    const double largest = largest_distance(*s.current, *s.opened);
    if (largest <= *scene.limit * (1 + tolerance)) continue;
    return numerical_error(
        fmt::format(
            "the step leads {:.6g} away from the surface as opened, beyond the limit of {:.6g}",
            largest, *scene.limit),
        s.id, "refine the net, soften or move the tool, or set a larger limit");
  }
  return {};
}

}  // namespace

void note_loose(SessionState& state, const MotionLaw& law) {
  if (!law.bounds()) return;
  std::string loose;
  std::vector<std::string> ids;
  for (const SceneSurface& s : selected_surfaces(state)) {
    if (holds_anything(s)) return;
    loose += (loose.empty() ? "" : ", ") + s.id;
    ids.push_back(s.id);
  }
  Note note(fmt::format("nothing holds {}: what presses on it moves all of it; hold its edges, "
                        "{{\"do\":\"hold\",\"mode\":\"position\"}}, or its outer rows, "
                        "{{\"do\":\"hold\",\"rows\":2}}",
                        loose),
            {ErrorCode::surface_loose, {{"surfaces", ids}}});
  note_once(state, std::move(note));
}

namespace {

/// Whether what the tools have done becomes the rest shape.
bool imprints(const Scene& scene, const ActiveStep& step) {
  return step.gap > 0 && std::ranges::any_of(scene.tools, [](const Tool& t) {
           return t.mode == ToolMode::imprint;
         });
}

}  // namespace

Expected<void> take(Act& act, const ActiveStep& step) {
  Eigen::Index first = 0;
  const bool imprinting = imprints(act.state, step);
  return each_selected(act, [&]<int D>(SceneShape<D>& s) -> Expected<void> {
    const Eigen::Index n = s.current->size();
    auto moved = s.current->with_control_points(step.control_points.middleRows(first, n));
    if (!moved) return std::unexpected(moved.error());
    if (moved->control_points() != s.current->control_points()) {
      s.current = std::make_shared<const Spline<D>>(*std::move(moved));
    }
    s.velocity =
        step.velocity.rows() > 0 ? Points(step.velocity.middleRows(first, n)) : Points(0, 3);
    if (imprinting) s.rest = s.current;
    first += n;
    return {};
  });
}

void record(SessionState& state, const ActiveStep& step, double seconds, std::string note) {
  StepRecord record;
  record.time = seconds;
  record.energy = step.energy;
  record.stretch = step.stretch;
  record.bend = step.bend;
  record.kinetic = step.kinetic;
  record.contact = step.contact;
  record.residual = step.residual;
  record.gap = step.gap;
  if (step.gap > 0) record.gap_tool = step.gap_tool;
  record.violation = step.violation;
  record.iterations = step.iterations;
  record.converged = step.converged;
  record.limited = step.limited;
  record.energy_error = step.energy_error;
  record.load_factor = step.load_factor;
  record.increments = step.increments;
  record.note = std::move(note);
  record.surface = state.selected.value_or(-1);
  if (state.body)
    record.largest_displacement =
        largest_displacement(state.bodies[static_cast<std::size_t>(*state.body)]);
  for (const SceneSurface& s : selected_surfaces(state)) {
    record.largest_displacement =
        std::max(record.largest_displacement, largest_distance(*s.current, *s.opened));
  }
  state.steps.push_back(std::move(record));
}

void note_model(Act& act, std::span<const SeamReport> seams, std::span<const std::string> notes) {
  act.state.seam_reports = seams_in_scene(seams, act.state);
  for (const std::string& note : notes) note_once(act.state, note);
  note_creases(act, seams);
}

Expected<void> yield(Act& act, double plasticity) {
  if (plasticity == 0) return {};
  for (SceneSurface& s : selected_surfaces(act.state)) {
    if (plasticity == 1) {
      s.rest = s.current;
      continue;
    }
    auto rest = s.rest->with_control_points(
        s.rest->control_points() +
        plasticity * (s.current->control_points() - s.rest->control_points()));
    if (!rest) return std::unexpected(rest.error());
    s.rest = std::make_shared<const Surface>(std::move(*rest));
  }
  return {};
}

namespace {

/// The steps of one command, on their way.
class Stepping {
 public:
  Stepping(Act& act, const Steps& asked) : act_(act), state_(act.state), asked_(asked) {}

  // A step is made again, and does not count, where the nets were refined under it or edges that
  // follow parted. Then nothing of it has been taken: a step begins from the same state until it is
  // accepted. The order of checks is that of their claims: what holds, then what follows, folds,
  // walls, and the limit, each on what the one before has left.
  Expected<StepsMade> run() {
    if (auto ready = prepare(); !ready) return std::unexpected(ready.error());
    while (made_.count < asked_.count) {
      const auto stepped = step();
      if (!stepped && Interruption::asked_for() && keeps_steps()) break;
      if (!stepped) return std::unexpected(stepped.error());
      if (!*stepped) continue;
      ++made_.count;
      if (made_.at_fold) break;
      const auto on = tell_progress(act_, asked_.before + made_.count,
                                    asked_.of > 0 ? asked_.of : asked_.count);
      if (!on && keeps_steps()) break;
      if (!on) return std::unexpected(on.error());
    }
    const Model* const model = act_.cache.models.last();
    if (!state_.body && made_.count > 0 && model != nullptr)
      note_model(act_, model->seams(), model->notes());
    return made_;
  }

 private:
  /// Finer nets where edges need them, before the first step.
  Expected<void> prepare() {
    if (state_.body) return {};
    if (auto surface = selected(act_); !surface) return std::unexpected(surface.error());
    if (asked_.increments && !has_shells(state_)) {
      return input_error(
          "only the load of a shell is increased in parts", "increments",
          R"(leave it out, or give {"do":"material","model":"shell"} with young and thickness)",
          {ErrorCode::shell_needed});
    }
    if (state_.permission == RefinePermission::automatic) {
      if (auto refined = refine_seams(act_); !refined) return refined;
    }
    if (auto refined = refine_trims(act_); !refined) return refined;
    return unite_followed(act_);
  }

  /// Whether a command that was stopped ends with the steps it has made.
  bool keeps_steps() {
    if (!asked_.may_stop || made_.count == 0) return false;
    made_.stopped = true;
    if (Interruption::asked_for()) Interruption::settle();
    return true;
  }

  /// Makes the next step; false: it is to be made again.
  Expected<bool> step() {
    if (!state_.body && made_.count == 0) {
      if (auto known = know_what_holds(act_); !known) return std::unexpected(known.error());
      if (auto asked = act_.law.ask_of_steps(state_, asked_.evolution, asked_.grips); !asked) {
        return std::unexpected(asked.error());
      }
      note_loose(state_, act_.law);
    }
    double seconds = 0;
    const auto step = solve(seconds);
    if (!step) return std::unexpected(step.error());
    if (!std::isfinite(step->energy) || !std::isfinite(step->residual)) return beyond_numbers();
    if (state_.body) {
      if (auto taken = take(act_, *step); !taken) return std::unexpected(taken.error());
      record(state_, *step, seconds, note_of(*step));
      for (const std::string& note : act_.cache.models.last()->notes()) note_once(state_, note);
      return true;
    }
    if (const auto finer = refine_nets(*step); !finer || *finer) {
      return finer ? Expected<bool>(false) : std::unexpected(finer.error());
    }
    return accept(*step, seconds);
  }

  /// What the model makes of the present state, within what was asked for.
  Expected<ActiveStep> solve(double& seconds) {
    if (auto known = know_what_holds(act_); !known) return std::unexpected(known.error());
    const auto kept = act_.cache.models.of(state_, asked_.evolution);
    if (!kept) return std::unexpected(kept.error());
    Model& model = **kept;
    const auto tools = tools_and_images(state_);
    if (!tools) return std::unexpected(tools.error());
    auto loads = model.loads(state_, asked_.grips);
    if (!loads) return std::unexpected(loads.error());
    const ActiveState before = active_state(state_);
    if (!state_.energy_before) state_.energy_before = model.energy(before);
    const auto start = std::chrono::steady_clock::now();
    auto step = model.step(before, *tools, *loads, asked_.increments.value_or(1));
    if (step && act_.law.shortens(state_, *step, *loads, model))
      step = model.step(before, *tools, *loads);
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return step;
  }

  /// Finer nets under tools that the present ones cannot follow. Whether there are any: then the
  /// step is made again.
  /// The step itself says how long spans are in units of the tool (`coarseness`); it is measured
  /// where contact was, which is not known before.
  Expected<bool> refine_nets(const ActiveStep& step) {
    if (step.coarseness <= coarse || state_.permission != RefinePermission::automatic ||
        refinements_ >= max_refinements || !asked_.grips.empty()) {
      return false;
    }
    bool any = false;
    for (const Tool& tool : state_.tools) {
      auto refined = refine_under(act_, tool, true);
      if (!refined) return refined;
      any = any || *refined;
    }
    refinements_ += any ? 1 : 0;
    return any;
  }

  /// Makes a step the shapes, as far as it may go; false: it is to be made again, with edges
  /// coupled more tightly.
  Expected<bool> accept(const ActiveStep& step, double seconds) {
    std::string note = note_of(step);
    if (!asked_.allow_held && asked_.grips.empty() && step.gap > 0 && nothing_moved(state_, step)) {
      const Error error = all_held(state_, step.gap_tool);
      if (holds_edges(state_)) return std::unexpected(error);
      note = error.what + "; " +
             error.remedy;  // requested, row by row or point by point: reported, not refused
    }
    if (!tried_) tried_.emplace(state_);
    const auto taken = tried_->accept(act_, step);
    if (!taken || !*taken) return taken;
    const bool first = asked_.before + made_.count == 0;
    const auto smaller = keep_step_unfolded(state_, tried_->before(), first, asked_.evolution);
    if (!smaller) return std::unexpected(smaller.error());
    if (!smaller->empty()) {
      made_.at_fold = true;
      note = *smaller;
    }
    if (auto stops = act_.meeting.after_step(act_, tried_->before()); !stops)
      return std::unexpected(stops.error());
    tried_.reset();
    if (auto within = check_limit(state_); !within) return std::unexpected(within.error());
    record(state_, step, seconds, std::move(note));
    return true;
  }

  Act& act_;
  SessionState& state_;
  const Steps& asked_;
  StepsMade made_;
  int refinements_ = 0;            // of nets under tools
  std::optional<Attempts> tried_;  // at the present step
};

}  // namespace

Expected<StepsMade> run(Act& act, const Steps& asked) { return Stepping(act, asked).run(); }

}  // namespace knead
