#pragma once

#include <span>
#include <string>
#include <vector>

#include "act.hpp"

namespace knead {

// Steps of what is selected, and what they leave on record.

inline constexpr double coarse = 0.5;      // spans longer than this share of a tool follow it less accurately
inline constexpr int max_refinements = 5;  // of the net under a tool at one place, if refining is permitted

/// Tells how many steps are done. Whether to go on; if not, `stopped` where a command may end early, else an error.
[[nodiscard]] Expected<bool> carries_on(Act& act, int done, int total);

/// `count` steps with the forces of the scene and these.
[[nodiscard]] Expected<void> run(Act& act, int count, const EvolutionPolicy& evolution,
                                 const std::vector<PointForce>& more = {}, int done = 0, int total = 0);
/// Share `plasticity` of the displacement becomes rest shape.
[[nodiscard]] Expected<void> yield(Act& act, double plasticity);

/// Makes what a step has found the shapes, and of tools that imprint the rest shapes.
[[nodiscard]] Expected<void> take(Act& act, const ActiveStep& step);
/// Adds a step to the record.
void record(Act& act, const ActiveStep& step, double seconds, std::string note);
/// The record of a step of what it says itself: neither the surface nor the displacement.
[[nodiscard]] StepRecord record_of(const ActiveStep& step, double seconds, std::string note);

/// The note on a step for the user: its own, or that the net is too coarse for a tool.
[[nodiscard]] std::string note_of(const ActiveStep& step);
/// Puts the seams of the model on record, and what it has to say; which seams are not smooth any more is noted.
void note_model(Act& act, std::span<const SeamReport> seams, std::span<const std::string> notes);
/// Notes where tools press on what nothing holds: it moves as a whole.
void note_loose(Act& act);
/// Says which seams were smooth and are not any more, why, and what keeps them so.
void note_creases(Act& act, std::span<const SeamReport> seams);

/// The error of a step whose numbers are not finite.
[[nodiscard]] std::unexpected<Error> beyond_numbers();

}  // namespace knead
