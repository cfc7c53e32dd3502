#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Pins control points (i, j), or a surface point, in addition to those already pinned.
struct PinCommand {
  std::vector<std::array<int, 2>> control_points;
  std::optional<Fractions> at;
  std::optional<Vector3> to;                   ///< default: where it is
  std::optional<std::string> components = {};  ///< of that point: "x", "yz", …; default: all
};

template <>
Expected<void> Executor::execute(const PinCommand& c);
void describe(PinCommand& c, Fields& fields);

}  // namespace knead
