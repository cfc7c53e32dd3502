#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Half a symmetric model: an edge stays in a plane and the surface perpendicular to it; or a whole surface that stays
/// its own mirror image.
struct SymmetryCommand {
  std::optional<EdgeChoice> edge;
  std::optional<std::string> mirror;  ///< "u" or "v"
  std::optional<Vector3> point, normal;
};

KNEAD_COMMAND(SymmetryCommand, "symmetry", "keep a symmetry") {
  v.field("edge", Presence::optional, c.edge,
          "u0, u1, v0 or v1: stays in a plane, the surface perpendicular to it; or:");
  v.field("mirror", Presence::optional, c.mirror,
          "u or v: the surface stays its own mirror image along that direction");
  v.field("point", Presence::optional, c.point, "[x, y, z] of the plane; default for `mirror`: the best plane");
  v.field("normal", Presence::optional, c.normal, "[x, y, z] of the plane");
}

}  // namespace knead
