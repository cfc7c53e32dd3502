#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Finds the lowest factors of the present loads at which the selected shell buckles: `"buckling":
/// [{"load_factor", "residual"}]` of the report. Changes nothing else: it is no part of the
/// history.
struct BucklingCommand {
  int count = 3;
};

Expected<void> execute(const BucklingCommand& c, Act& act);
void describe(BucklingCommand& c, Fields& fields);

}  // namespace knead
