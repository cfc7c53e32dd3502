#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Puts a tool into the scene, or replaces the one of that name.
struct ToolCommand {
  std::string name = "tool";
  std::string shape = "sphere";
  std::optional<double> radius;  ///< default: a tenth of the surface's bounding-box diagonal
  std::optional<double> minor, height, rounding, thickness, top_radius;
  std::optional<Vector3> sizes;  ///< semi-axes or half sizes
  std::optional<std::array<double, 2>> exponents;
  std::optional<std::string> surface;  ///< of shape "surface": its id
  std::optional<Vector3> axis;         ///< where the tool's own z points
  std::optional<Vector3> scale;        ///< along its own axes
  std::optional<Vector3> position;     ///< of the centre; or:
  std::optional<Fractions> at;         ///< centre on the surface
  ToolMode mode = ToolMode::collision;
  std::optional<double> stiffness;  ///< default: 1e4 for collision, 100 for proximity
  std::optional<double> range;      ///< default: half the size
  ToolDirection direction = ToolDirection::pull;
  bool rigid = false;
  double friction = 0;
  double plasticity = 0;
  std::optional<bool> middle = {};  ///< of what is visible, instead of `at`
  bool relative = false;            ///< lengths and position are fractions of the bounding-box diagonal
};

std::span<const Choice> choices(ToolMode);

std::span<const Choice> choices(ToolDirection);

template <>
Expected<void> Executor::execute(const ToolCommand& c);
void describe(ToolCommand& c, Fields& fields);

}  // namespace knead
