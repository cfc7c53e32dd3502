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

Expected<void> execute(const UndoCommand& c, Act& act);
void describe(UndoCommand& c, Fields& fields);

Expected<void> execute(const RedoCommand& c, Act& act);
void describe(RedoCommand& c, Fields& fields);

}  // namespace knead
