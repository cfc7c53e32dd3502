#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Removes knots while the shape changes by no more than a length.
struct CoarsenCommand {
  double tolerance = 0;
};

KNEAD_COMMAND(CoarsenCommand, "coarsen", "remove knots where the shape changes by no more than a tolerance") {
  v.field("tolerance", Presence::required, c.tolerance, "length");
}

}  // namespace knead
