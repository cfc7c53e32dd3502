#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Frees what is held of the selected surfaces: all, or the kinds that are named.
struct ReleaseCommand {
  std::optional<std::vector<std::string>> what;  ///< left out: all
};

template <>
Expected<void> Executor::execute(const ReleaseCommand& c);
void describe(ReleaseCommand& c, Fields& fields);

}  // namespace knead
