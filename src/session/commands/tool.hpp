#pragma once

#include "../shape_fields.hpp"

namespace knead {

/// Adds a tool to the scene, or replaces the one of that name.
struct ToolCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  std::string name = "tool";
  std::string shape = "sphere";
  ShapeFields measures;
  std::optional<Vector3> axis;                       ///< direction of the tool's own z; or:
  std::optional<std::array<double, 4>> orientation;  ///< quaternion [x, y, z, w]
  std::optional<Vector3> scale;                      ///< along its own axes
  std::optional<Vector3> position;                   ///< of the centre; or:
  std::optional<Fractions> at;                       ///< centre on the surface
  ToolMode mode = ToolMode::collision;
  std::optional<double> stiffness;  ///< default: 1e4 for collision, 100 for proximity
  std::optional<double> range;      ///< default: half the size
  ToolDirection direction = ToolDirection::pull;
  bool rigid = false;
  double friction = 0;
  double plasticity = 0;
  ToolTouch touches = ToolTouch::visible;
  std::optional<bool> middle = {};  ///< of the visible part, instead of `at`
  bool relative = false;  ///< lengths and position are fractions of the bounding-box diagonal
};

std::span<const Choice> choices(ToolMode);

std::span<const Choice> choices(ToolDirection);

std::span<const Choice> choices(ToolTouch);

Expected<void> execute(const ToolCommand& c, Act& act);
void describe(ToolCommand& c, Fields& fields);

/// The rotation of a quaternion [x, y, z, w]. Error (input): it is zero or not finite.
[[nodiscard]] Expected<Eigen::Quaterniond> rotation_of(const std::array<double, 4>& orientation);

/// The surface point at fractions of the domain, or in the middle of the visible part. Errors:
/// those of `place_on`.
[[nodiscard]] Expected<Point> point_at(Act& act, SceneSurface& surface, const SurfacePlace& place);

}  // namespace knead
