#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Takes hold of a surface point with a footprint, drags it and lets go.
struct DragCommand {
  Fractions at = {0.5, 0.5};
  Vector3 by = {0, 0, 0};
  std::optional<double> radius;  ///< default: a tenth of the diagonal
  double strength = 1e4;
  int steps = 4;
  double plasticity = 1;
  bool relative = false;
};

KNEAD_COMMAND(DragCommand, "drag", "take hold of a surface point, drag it and let go, as one command") {
  v.field("at", Presence::required, c.at, "[s, t]: the surface point, at fractions of its domain");
  v.field("by", Presence::required, c.by, "[dx, dy, dz]");
  v.field("radius", Presence::optional, c.radius, "of the footprint, a length; default: 0.1 of the diagonal");
  v.field("strength", Presence::optional, c.strength, "spring constant of the grip");
  v.field("steps", Presence::optional, c.steps, "steps on the way");
  v.field("plasticity", Presence::optional, c.plasticity, "share of the result that stays, 0 to 1");
  v.field("relative", Presence::optional, c.relative, "`by` and radius are fractions of the bounding-box diagonal");
}

}  // namespace knead
