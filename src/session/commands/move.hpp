#pragma once

#include "../command_fields.hpp"

namespace knead {

struct MoveCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  std::optional<std::string> tool;  ///< default: the only tool
  Vector3 by = {0, 0, 0};
  bool relative = false;  ///< `by` is in fractions of the bounding-box diagonal
};

Expected<void> execute(const MoveCommand& c, Act& act);
void describe(MoveCommand& c, Fields& fields);

}  // namespace knead
