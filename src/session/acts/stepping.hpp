#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "act.hpp"

namespace knead {

// Steps of what is selected, and what they leave on record.

// Spans longer than this share of a tool follow it less accurately.
inline constexpr double coarse = 0.5;
// Of the net under a tool at one place, if refining is permitted.
inline constexpr int max_refinements = 5;

/// What a command asks of steps.
struct Steps {
  int count = 1;
  EvolutionPolicy evolution;
  std::vector<PointForce> grips = {};  ///< besides the forces of the scene
  int before = 0,
      of = 0;  ///< steps of the command made before these, and all of them; 0: these are all
  std::optional<int> increments = {};  ///< of the load of a shell; default: 1
  bool allow_held = false;             ///< a tool may touch what is held alone
  bool may_stop = false;  ///< stopped after some step, what has been made of them stays
};

/// What became of it.
struct StepsMade {
  int count = 0;
  bool at_fold = false;  ///< the last one was made smaller, as more would fold a face: none follows
  bool stopped = false;
};

/// Makes the selected shapes evolve. Errors: those of the model and of its steps (numerical), a
/// face that would fold, a limit that would be exceeded, a tool under which nothing is free, a
/// command that was stopped.
[[nodiscard]] Expected<StepsMade> run(Act& act, const Steps& asked);
/// Tells how many steps are done. Error: it was stopped, or interrupted.
[[nodiscard]] Expected<void> tell_progress(const Act& act, int steps, int of);
/// Share `plasticity` of the displacement becomes rest shape.
[[nodiscard]] Expected<void> yield(Act& act, double plasticity);

/// Makes what a step has found the shapes, and of tools that imprint the rest shapes.
[[nodiscard]] Expected<void> take(Act& act, const ActiveStep& step);
/// Adds a step to the record.
void record(SessionState& state, const ActiveStep& step, double seconds, std::string note);

/// The note on a step for the user: its own, or that the net is too coarse for a tool.
[[nodiscard]] std::string note_of(const ActiveStep& step);
/// Puts the seams of the model on record, and what it has to say; which seams are not smooth any
/// more is noted.
void note_model(Act& act, std::span<const SeamReport> seams, std::span<const std::string> notes);
/// Notes where tools press on what nothing holds: it moves as a whole.
void note_loose(SessionState& state, const MotionLaw& law);
/// Says which seams were smooth and are not any more, why, and what keeps them so.
void note_creases(Act& act, std::span<const SeamReport> seams);

}  // namespace knead
