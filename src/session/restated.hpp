#pragma once

#include "commands.hpp"

namespace knead {

/// The command that asks for a constraint on the selected surface.
[[nodiscard]] Command restated(const Constraint& constraint);

/// The constraint that a command asks for; nothing where it asks for none, or for several.
[[nodiscard]] std::optional<Constraint> constraint_of(const Command& command);

}  // namespace knead
