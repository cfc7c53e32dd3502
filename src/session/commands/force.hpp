#pragma once

#include "../command_fields.hpp"

namespace knead {

/// A force on one surface point or edge, acting until it is removed (thesis Eq. 4.24).
struct ForceCommand {
  SceneForce force;  ///< on the first selected surface
};

std::span<const Choice> choices(PointForceKind);

/// Errors (input): a force lacks what its kind needs, has what its kind has not, or a number is out of range.
[[nodiscard]] Expected<void> check_force(const SceneForce& force);

/// Adds a force, or replaces the one of that name.
void put_force(Scene& scene, SceneForce force);

template <>
Expected<void> Executor::execute(const ForceCommand& c);
void describe(ForceCommand& c, Fields& fields);

}  // namespace knead
