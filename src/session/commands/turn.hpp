#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Rotates a tool about its centre.
struct TurnCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  std::optional<std::string> tool;
  Vector3 axis = {0, 0, 1};
  double angle = 0;  ///< degrees
};

Expected<void> execute(const TurnCommand& c, Act& act);
void describe(TurnCommand& c, Fields& fields);

}  // namespace knead
