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

KNEAD_COMMAND(StrokeCommand, "stroke", "press a tool along a path and take it back, as one command") {
  v.field("tool", Presence::optional, c.tool, "its name; default: the only tool");
  v.field("path", Presence::required, c.path, "[[x, y, z], …] positions of its centre");
  v.field("steps", Presence::optional, c.steps, "steps at each position");
  v.field("plasticity", Presence::optional, c.plasticity, "share of the result that stays, 0 to 1");
  v.field("relative", Presence::optional, c.relative,
          "the path is measured from where the tool is, in fractions of the bounding-box diagonal");
}

}  // namespace knead
