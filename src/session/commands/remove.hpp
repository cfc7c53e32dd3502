#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Removes a tool from the scene; its plastic deformation remains. Or a measurement.
struct RemoveCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  std::optional<std::string> tool;         ///< default: the only tool
  std::optional<std::string> measurement;  ///< its name, instead of a tool
};

Expected<void> execute(const RemoveCommand& c, Act& act);
void describe(RemoveCommand& c, Fields& fields);

}  // namespace knead
