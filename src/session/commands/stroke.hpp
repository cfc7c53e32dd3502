#pragma once

#include "../command_fields.hpp"

namespace knead {

/// When what a tool does to the shape becomes the shape.
enum class StrokePlasticity {
  material,  ///< as the material says
  along,     ///< every place leaves its dent
  release,   ///< what is there when the tool is lifted stays
};

std::span<const Choice> choices(StrokePlasticity);

/// Moves a tool along a path and takes it back: press, drag and release as one.
struct StrokeCommand {
  std::optional<std::string> tool;
  std::vector<Vector3> path;  ///< positions of the tool's centre
  int steps = 2;              ///< at each of them
  double plasticity = 1;
  std::optional<StrokePlasticity> plastic;  ///< default: material
  std::optional<bool>
      open;  ///< true: the tool stays down, and the next stroke of this tool goes on with this one
  /// The path is measured from where the tool is, in fractions of the diagonal.
  bool relative = false;
  std::optional<ThroughAllowance> allow = {};
};

Expected<void> execute(const StrokeCommand& c, Act& act);
void describe(StrokeCommand& c, Fields& fields);

}  // namespace knead
