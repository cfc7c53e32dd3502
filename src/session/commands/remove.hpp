#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Takes a tool out of the scene; of what it did, its plasticity stays.
struct RemoveCommand {
  std::optional<std::string> tool;  ///< default: the only tool
};

KNEAD_COMMAND(RemoveCommand, "remove", "take a tool or force out of the scene; its plasticity stays") {
  v.field("tool", Presence::optional, c.tool, "its name; default: the only one");
}

}  // namespace knead
