#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Protects surfaces: what is locked cannot be selected, and so nothing moves it.
struct LockCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  std::optional<std::vector<std::string>> surfaces;  ///< by default the selected ones
  bool locked = true;                                ///< false: they can be selected again
};

Expected<void> execute(const LockCommand& c, Act& act);
void describe(LockCommand& c, Fields& fields);

}  // namespace knead
