#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Scales a tool along its own axes.
struct ScaleCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  std::optional<std::string> tool;
  Vector3 by = {1, 1, 1};
};

Expected<void> execute(const ScaleCommand& c, Act& act);
void describe(ScaleCommand& c, Fields& fields);

}  // namespace knead
