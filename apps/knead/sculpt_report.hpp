#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/session/session.hpp"
#include "parts.hpp"

namespace knead::cli {

/// What a script has made of a session.
struct Outcome {
  double time = 0, energy_before = 0, energy_after = 0, residual = 0, largest_displacement = 0, gap = 0;
  int moved = 0, surfaces = 0, bodies = 0;
  std::vector<RepeatedSurface> places;
  std::vector<Note> notes;  ///< of the session, and on edges that are open
};

/// \param opened how many surfaces the file had: those that follow were converted, and are written as B-splines
[[nodiscard]] Outcome outcome_of(Session& session, std::size_t opened);

/// The JSON of `--report`. Errors: a probe that cannot be read.
[[nodiscard]] Expected<std::string> report_of(const SessionState& state, const Outcome& outcome);
/// The SVG of `--picture`, the displacement of the selected surface. Errors: there is none, or it has no area.
[[nodiscard]] Expected<std::string> picture_of(const SessionState& state);

[[nodiscard]] const char* name_of(SeamContinuity continuity);
[[nodiscard]] std::string name_of(const SessionState& state, const PatchEdge& edge);

}  // namespace knead::cli
