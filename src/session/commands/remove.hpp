#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Takes a tool out of the scene; of what it did, its plasticity stays.
struct RemoveCommand {
  std::optional<std::string> tool;  ///< default: the only tool
};

template <>
Expected<void> Executor::execute(const RemoveCommand& c);
void describe(RemoveCommand& c, Fields& fields);

}  // namespace knead
