#include "history.hpp"

namespace knead {

// The session itself goes to another state of its history; no state is changed.

template <>
Expected<void> Executor::execute(const UndoCommand&) {
  return {};
}

template <>
Expected<void> Executor::execute(const RedoCommand&) {
  return {};
}

}  // namespace knead
