#pragma once

#include <string>

#include "knead/session/session_info.hpp"

namespace knead::studio {

using knead::error_json;
using knead::steps_json;

/// The content of panels: surfaces, tools, settings, notes, the last step; no control points (docs/studio.md).
[[nodiscard]] std::string state_json(const Session& session);

/// One line per command in effect, each in JSON.
[[nodiscard]] std::string journal_json(const Session& session);

}  // namespace knead::studio
