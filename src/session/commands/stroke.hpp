#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Moves a tool along a path, stepping on the way, and takes it back: press, drag and release as one.
struct StrokeCommand {
  std::optional<std::string> tool;
  std::vector<Vector3> path;  ///< positions of the tool's centre
  int steps = 2;              ///< at each of them
  double plasticity = 1;
  bool relative = false;  ///< the path is measured from where the tool is, in fractions of the diagonal
};

template <>
Expected<void> Executor::execute(const StrokeCommand& c);
void describe(StrokeCommand& c, Fields& fields);

}  // namespace knead
