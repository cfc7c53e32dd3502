#pragma once

#include <string>
#include <string_view>

#include "knead/session/session_info.hpp"

namespace knead::studio {

using knead::error_json;
using knead::steps_json;

/// The content of panels: surfaces, tools, settings, notes, the last step; no control points (docs/studio.md).
[[nodiscard]] std::string state_json(const Session& session);

/// One line per command in effect, each in JSON.
[[nodiscard]] std::string journal_json(const Session& session);

/// Carries out commands, one per line in JSON, as one act (`Session::act`). Without any, the last entry of the history
/// goes if it has changed nothing (`Session::drop_unchanged`).
[[nodiscard]] Expected<void> carry_out(Session& session, std::string_view lines, const ActOptions& options,
                                       const Session::Progress& progress);

/// Undo goes no further back than what stands now or, with `commands` of 0 or more, than after so many of the journal.
/// Returns how many commands of the journal are behind that.
std::size_t begin_history(Session& session, int commands);

}  // namespace knead::studio
