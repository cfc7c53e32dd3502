#pragma once

#include "commands.hpp"

namespace knead {

/// The command that puts a constraint on the selected shape.
template <int D>
[[nodiscard]] Command restated(const ConstraintOf<D>& constraint);
[[nodiscard]] inline Command restated(const Constraint& constraint) {
  return restated<2>(constraint);
}

/// The constraint that a command makes on a shape of so many directions; nothing if it makes none
/// or several.
template <int D>
[[nodiscard]] std::optional<ConstraintOf<D>> constraint_of(const Command& command);

}  // namespace knead
