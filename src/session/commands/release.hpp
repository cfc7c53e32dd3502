#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Frees what is held on the selected surfaces: all of it, or the named kinds.
struct ReleaseCommand {
  static constexpr ActsOn acts_on = ActsOn::shapes;
  std::optional<std::vector<std::string>> what;  ///< left out: all
};

Expected<void> execute(const ReleaseCommand& c, Act& act);
void describe(ReleaseCommand& c, Fields& fields);

}  // namespace knead
