#pragma once

#include "../command_fields.hpp"

namespace knead {

/// A force on one surface point, there until it is removed (thesis Eq. 4.24).
struct ForceCommand {
  SceneForce force;  ///< on the first selected surface
};

inline constexpr Choice<PointForceKind> point_force_kinds[] = {{"spring", PointForceKind::spring},
                                                               {"volcano", PointForceKind::volcano}};

KNEAD_COMMAND(ForceCommand, "force", "a force on one surface point, until `remove`") {
  v.field("name", Presence::optional, c.force.name, "what `remove` calls it");
  v.choice("kind", c.force.kind, std::span<const Choice<PointForceKind>>(point_force_kinds),
           "spring draws the point to `to`; volcano drives it away from there");
  v.field("at", Presence::required, c.force.at, "[s, t]: the surface point, at fractions of its domain");
  v.field("to", Presence::required, c.force.to, "[x, y, z]");
  v.field("strength", Presence::optional, c.force.strength, "spring constant, or k of the volcano's k/r²");
  v.field("core", Presence::optional, c.force.core, "length within which a volcano no longer grows");
}

}  // namespace knead
