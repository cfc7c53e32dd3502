#pragma once

#include "tool.hpp"

namespace knead {

/// Changes an existing tool: only the given fields.
struct EditToolCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  std::optional<std::string> tool;  ///< its name; default: the only tool
  std::optional<std::string> name;  ///< the same
  std::optional<std::string> shape;
  ShapeFields measures;
  std::optional<Vector3>
      axis;  ///< rotated there the shortest way, without twist about its own axis
  std::optional<std::array<double, 4>> orientation;
  std::optional<Vector3> scale;
  std::optional<Vector3> position;
  std::optional<Fractions> at;
  std::optional<bool> middle;  ///< of the visible part, instead of `at`
  std::optional<ToolMode> mode;
  std::optional<double> stiffness, range;
  std::optional<ToolDirection> direction;
  std::optional<ToolTouch> touches;
  std::optional<bool> rigid;
  std::optional<double> friction, plasticity;
  bool relative = false;
};

Expected<void> execute(const EditToolCommand& c, Act& act);
void describe(EditToolCommand& c, Fields& fields);

}  // namespace knead
