#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Makes planes, cylinders and the like, on which faces of the file lie, exact B-spline surfaces
/// that can be sculpted, and whose edges can follow.
struct ConvertCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  std::optional<std::string> surface = {};                ///< id of the entity, or of a face on it
  std::optional<std::vector<std::string>> surfaces = {};  ///< several
  bool neighbours = false;  ///< those that meet faces on the selected surfaces
};

Expected<void> execute(const ConvertCommand& c, Act& act);
void describe(ConvertCommand& c, Fields& fields);

}  // namespace knead
