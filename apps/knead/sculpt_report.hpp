#pragma once

#include <string>

#include "knead/session/report.hpp"

namespace knead::cli {

/// The JSON of `--report`. Errors: a probe that cannot be read.
[[nodiscard]] Expected<std::string> report_of(const SessionState& state, const Outcome& outcome);
/// The SVG of `--picture`, the displacement of the selected surface. Errors: there is none, or it has no area.
[[nodiscard]] Expected<std::string> picture_of(const SessionState& state);

}  // namespace knead::cli
