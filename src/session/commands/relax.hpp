#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Smooths the surface around a point: one step of a plate under tension that has no rest shape, all else held.
/// `strength` is the share of a bump of that radius which goes.
struct RelaxCommand {
  Fractions at = {0.5, 0.5};
  std::optional<double> radius;  ///< default: a tenth of the diagonal
  double strength = 0.5;
  bool relative = false;
};

KNEAD_COMMAND(RelaxCommand, "relax", "smooth the surface around a point") {
  v.field("at", Presence::required, c.at, "[s, t]: the surface point, at fractions of its domain");
  v.field("radius", Presence::optional, c.radius, "how far it reaches, a length; default: 0.1 of the diagonal");
  v.field("strength", Presence::optional, c.strength, "share of a bump of that size that goes, > 0, up to 1");
  v.field("relative", Presence::optional, c.relative, "radius is a fraction of the bounding-box diagonal");
}

}  // namespace knead
