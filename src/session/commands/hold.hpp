#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Holds the outer `rows` rows of control points on every side; 0 holds none. Replaces an earlier hold.
struct HoldCommand {
  int rows = 2;
};

template <>
Expected<void> Executor::execute(const HoldCommand& c);
void describe(HoldCommand& c, Fields& fields);

}  // namespace knead
