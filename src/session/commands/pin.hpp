#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Pins control points (i, j), or a surface point, in addition to what is pinned already.
struct PinCommand {
  std::vector<std::array<int, 2>> control_points;
  std::optional<Fractions> at;
  std::optional<Vector3> to;  ///< default: where it is
};

KNEAD_COMMAND(PinCommand, "pin", "hold control points or a surface point, in addition to those held already") {
  v.field("control_points", Presence::optional, c.control_points, "list of [i, j], counted from 0");
  v.field("at", Presence::optional, c.at, "[s, t]: a surface point, at fractions of its domain");
  v.field("to", Presence::optional, c.to, "[x, y, z] where that point goes; default: where it is");
}

}  // namespace knead
