#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Removes knots while the shape changes by no more than a length.
struct CoarsenCommand {
  double tolerance = 0;
};

template <>
Expected<void> Executor::execute(const CoarsenCommand& c);
void describe(CoarsenCommand& c, Fields& fields);

}  // namespace knead
