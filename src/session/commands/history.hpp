#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Takes back the last command that was not taken back yet.
struct UndoCommand {};

/// Does again what was taken back last.
struct RedoCommand {};

template <>
Expected<void> Executor::execute(const UndoCommand& c);
void describe(UndoCommand& c, Fields& fields);

template <>
Expected<void> Executor::execute(const RedoCommand& c);
void describe(RedoCommand& c, Fields& fields);

}  // namespace knead
