#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Pins control points (i, j), or a point, in addition to those already pinned.
struct PinCommand {
  static constexpr ActsOn acts_on = ActsOn::shapes;
  std::vector<std::vector<int>> control_points;  ///< indices in each direction
  std::optional<std::vector<double>> at;         ///< a fraction for each direction
  std::optional<Vector3> to;                     ///< default: where it is
  std::optional<std::string> components = {};    ///< of that point: "x", "yz", …; default: all
};

Expected<void> execute(const PinCommand& c, Act& act);
void describe(PinCommand& c, Fields& fields);

}  // namespace knead
