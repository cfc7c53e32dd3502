#include "history.hpp"

namespace knead {

// The session itself moves to another state of its history; no state is changed.

void describe(UndoCommand&, Fields& fields) { fields.name("undo", "undo the last command"); }

void describe(RedoCommand&, Fields& fields) { fields.name("redo", "redo the command undone last"); }

Expected<void> execute(const UndoCommand&, Act&) { return {}; }

Expected<void> execute(const RedoCommand&, Act&) { return {}; }

}  // namespace knead
