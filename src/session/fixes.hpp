#pragma once

#include <span>
#include <string>

#include "describe/describe.hpp"
#include "knead/base/error_code.hpp"
#include "knead/session/command.hpp"

namespace knead {

/// The names of codes, and what they say.
[[nodiscard]] std::span<const Choice> choices(ErrorCode code);
[[nodiscard]] std::span<const Choice> choices(FixCode code);

/// All codes with their values and fixes, as tables in Markdown.
[[nodiscard]] std::string diagnostics_table();

}  // namespace knead
