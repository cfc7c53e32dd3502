#pragma once

#include "../command_fields.hpp"

namespace knead {

struct MoveCommand {
  std::optional<std::string> tool;  ///< default: the only tool
  Vector3 by = {0, 0, 0};
  bool relative = false;  ///< `by` is in fractions of the bounding-box diagonal
};

KNEAD_COMMAND(MoveCommand, "move", "move a tool") {
  v.field("tool", Presence::optional, c.tool, "its name; default: the only tool");
  v.field("by", Presence::required, c.by, "[dx, dy, dz]");
  v.field("relative", Presence::optional, c.relative, "fractions of the surface's bounding-box diagonal, not lengths");
}

}  // namespace knead
