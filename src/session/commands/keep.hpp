#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Keeps a curve of the surface where it is: an isoparametric line, or a polyline of (s, t).
struct KeepCommand {
  Keep keep;
};

KNEAD_COMMAND(KeepCommand, "keep", "hold a curve of the surface") {
  v.field("u", Presence::optional, c.keep.u, "the line u = const at this fraction of the domain; or:");
  v.field("v", Presence::optional, c.keep.v, "the line v = const; or:");
  v.field("curve", Presence::optional, c.keep.curve, "[[s, t], …]: a polyline in the domain");
  v.field("tolerance", Presence::optional, c.keep.tolerance, "of a polyline, as a share of the motion around it");
}

}  // namespace knead
