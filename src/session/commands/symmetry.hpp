#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Half a symmetric model: an edge stays in a plane and the surface perpendicular to it; or a whole
/// surface that remains its own mirror image.
struct SymmetryCommand {
  std::optional<EdgeChoice> edge;
  std::optional<std::string> mirror;  ///< "u" or "v"
  std::optional<Vector3> point, normal;
};

Expected<void> execute(const SymmetryCommand& c, Act& act);
void describe(SymmetryCommand& c, Fields& fields);

}  // namespace knead
