#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Scales a tool along its own axes.
struct ScaleCommand {
  std::optional<std::string> tool;
  Vector3 by = {1, 1, 1};
};

KNEAD_COMMAND(ScaleCommand, "scale", "scale a tool along its own axes") {
  v.field("tool", Presence::optional, c.tool, "its name; default: the only tool");
  v.field("by", Presence::required, c.by, "[a, b, c], factors > 0");
}

}  // namespace knead
