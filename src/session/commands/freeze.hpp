#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Freezes a region of the parameter domain, rounded outward to whole spans.
struct FreezeCommand {
  Freeze freeze;
};

KNEAD_COMMAND(FreezeCommand, "freeze", "hold a region, rounded outward to whole knot spans") {
  v.field("region", Presence::required, c.freeze.region, "[[s0, s1], [t0, t1]], fractions of the domain");
}

}  // namespace knead
