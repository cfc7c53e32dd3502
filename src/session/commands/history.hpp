#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Reverts the last command not yet undone.
struct UndoCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
};

/// Repeats the command undone last.
struct RedoCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
};

template <>
Expected<void> Executor::execute(const UndoCommand& c);
void describe(UndoCommand& c, Fields& fields);

template <>
Expected<void> Executor::execute(const RedoCommand& c);
void describe(RedoCommand& c, Fields& fields);

}  // namespace knead
