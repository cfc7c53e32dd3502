#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Takes back the last command that was not taken back yet.
struct UndoCommand {};

/// Does again what was taken back last.
struct RedoCommand {};

KNEAD_COMMAND(UndoCommand, "undo", "take back the last command") {}

KNEAD_COMMAND(RedoCommand, "redo", "do again what was taken back last") {}

}  // namespace knead
