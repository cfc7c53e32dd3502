#pragma once

#include "commands.hpp"

namespace knead {

/// The command that puts a constraint on the selected surface.
[[nodiscard]] Command restated(const Constraint& constraint);

/// The constraint that a command makes; nothing if it makes none or several.
[[nodiscard]] std::optional<Constraint> constraint_of(const Command& command);

}  // namespace knead
