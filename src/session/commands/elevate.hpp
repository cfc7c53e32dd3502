#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Raises the degree, the same shape.
struct ElevateCommand {
  std::array<int, 2> by = {1, 1};
};

KNEAD_COMMAND(ElevateCommand, "elevate", "raise the degree, the same shape") {
  v.field("by", Presence::optional, c.by, "[in u, in v]");
}

}  // namespace knead
