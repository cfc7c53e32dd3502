#pragma once

#include "../command_fields.hpp"

namespace knead {

/// The kinds of `Force`, in their order.
enum class ForceKind { spring, volcano, dead, line, moment };

std::span<const Choice> choices(ForceKind);

/// A force on one point or edge of the first selected surface, or on one point of the selected
/// body, until it is removed (thesis Eq. 4.24). Each kind has some of the fields.
struct ForceCommand {
  static constexpr ActsOn acts_on = ActsOn::shapes;
  std::string name = "force";
  ForceKind kind = ForceKind::spring;
  std::optional<std::vector<double>> at = {};
  std::optional<Vector3> to = {};
  double strength = 10, core = 0.1;
  std::optional<Vector3> vector = {};
  std::optional<EdgeChoice> edge = {};
  std::optional<double> moment = {};
};

/// The force that is meant. Errors (input): it lacks what its kind needs, has what its kind has
/// not, or a number is out of range.
[[nodiscard]] Expected<Force> force_of(const ForceCommand& c);

/// The command that makes a force.
[[nodiscard]] ForceCommand restated(const SceneForce& force);

/// Adds a force, or replaces the one of that name.
void put_force(Scene& scene, SceneForce force);

Expected<void> execute(const ForceCommand& c, Act& act);
void describe(ForceCommand& c, Fields& fields);

}  // namespace knead
