#include "history.hpp"

namespace knead {

// The session itself moves to another state of its history; no state is changed.

void describe(UndoCommand&, Fields& fields) { fields.name("undo", "take back the last command"); }

void describe(RedoCommand&, Fields& fields) { fields.name("redo", "do again what was taken back last"); }

template <>
Expected<void> Executor::execute(const UndoCommand&) {
  return {};
}

template <>
Expected<void> Executor::execute(const RedoCommand&) {
  return {};
}

}  // namespace knead
