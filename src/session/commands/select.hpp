#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Chooses the surfaces that the following commands act on. A document with one surface has it selected already.
struct SelectCommand {
  std::optional<std::string> surface;                ///< id of the entity, "#123"
  std::optional<std::vector<std::string>> surfaces;  ///< several, which then move together
  bool connected = false;                            ///< and all that seams connect with these
};

KNEAD_COMMAND(SelectCommand, "select", "choose the surfaces that the following commands act on") {
  v.field("surface", Presence::optional, c.surface, "entity id as `knead info` lists it, \"#123\"");
  v.field("surfaces", Presence::optional, c.surfaces, "several, which move together, coupled along their seams");
  v.field("connected", Presence::optional, c.connected, "and all surfaces that seams connect with these");
}

}  // namespace knead
