#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Finds the lowest natural frequencies of the selected surfaces about their present state:
/// `"modes": [{"frequency", "residual"}]` of the report. Changes nothing else: it is no part of the
/// history.
struct ModesCommand {
  int count = 10;
};

Expected<void> execute(const ModesCommand& c, Act& act);
void describe(ModesCommand& c, Fields& fields);

}  // namespace knead
