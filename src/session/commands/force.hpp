#pragma once

#include "../command_fields.hpp"

namespace knead {

/// A force on one surface point or edge, acting until it is removed (thesis Eq. 4.24).
struct ForceCommand {
  SceneForce force;  ///< on the first selected surface
};

std::span<const Choice> choices(PointForceKind);

template <>
Expected<void> Executor::execute(const ForceCommand& c);
void describe(ForceCommand& c, Fields& fields);

}  // namespace knead
