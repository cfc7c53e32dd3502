#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Holds the outer `rows` rows of control points on every side; 0 holds none. Replaces an earlier hold.
struct HoldCommand {
  int rows = 2;
};

KNEAD_COMMAND(HoldCommand, "hold", "hold the outer rows of control points on every side") {
  v.field("rows", Presence::optional, c.rows, "how many; 0 holds none");
}

}  // namespace knead
