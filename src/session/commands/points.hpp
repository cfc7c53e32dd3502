#pragma once

#include "../named_points.hpp"

namespace knead {

/// Moves control points by hand. The shape that comes is clay: it stays.
struct PointsCommand {
  NamedPoints points;
  std::optional<Vector3> by;  ///< all alike; or:
  std::vector<Vector3> to;    ///< one place for each
  bool relative = false;      ///< `by` is in fractions of the bounding-box diagonal
};

KNEAD_COMMAND(PointsCommand, "points", "move control points of the selected surface by hand, for good") {
  visit_points(c.points, v);
  v.field("by", Presence::optional, c.by, "[dx, dy, dz] for all of them; or:");
  v.field("to", Presence::optional, c.to, "[[x, y, z], …]: a place for each, in the order they are named");
  v.field("relative", Presence::optional, c.relative, "`by` is in fractions of the bounding-box diagonal");
}

}  // namespace knead
