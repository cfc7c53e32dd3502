#pragma once

#include <string>

#include "knead/session/session.hpp"

namespace knead::studio {

/// {"error": {what, where, remedy, message, kind}}.
[[nodiscard]] std::string error_json(const Error& error);

/// What panels show: surfaces, tools, settings, notes, the last step; no control points (docs/studio.md).
[[nodiscard]] std::string state_json(const Session& session);

/// The steps from number `first` on, [{energy, stretch, …}, …].
[[nodiscard]] std::string steps_json(const SessionState& state, std::size_t first);

/// One line per command whose effect stands, each in JSON.
[[nodiscard]] std::string journal_json(const Session& session);

}  // namespace knead::studio
