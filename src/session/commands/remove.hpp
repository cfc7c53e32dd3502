#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Removes a tool from the scene; its plastic deformation remains.
struct RemoveCommand {
  std::optional<std::string> tool;  ///< default: the only tool
};

template <>
Expected<void> Executor::execute(const RemoveCommand& c);
void describe(RemoveCommand& c, Fields& fields);

}  // namespace knead
