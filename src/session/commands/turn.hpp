#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Turns a tool about its centre.
struct TurnCommand {
  std::optional<std::string> tool;
  Vector3 axis = {0, 0, 1};
  double angle = 0;  ///< degrees
};

KNEAD_COMMAND(TurnCommand, "turn", "turn a tool about its centre") {
  v.field("tool", Presence::optional, c.tool, "its name; default: the only tool");
  v.field("axis", Presence::optional, c.axis, "[x, y, z]");
  v.field("angle", Presence::required, c.angle, "degrees");
}

}  // namespace knead
