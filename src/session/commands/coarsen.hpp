#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Removes knots while the shape changes by no more than a length.
struct CoarsenCommand {
  double tolerance = 0;
};

Expected<void> execute(const CoarsenCommand& c, Act& act);
void describe(CoarsenCommand& c, Fields& fields);

}  // namespace knead
