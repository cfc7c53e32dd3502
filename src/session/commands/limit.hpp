#pragma once

#include "../command_fields.hpp"

namespace knead {

/// No point may be further than this from the surface as opened.
struct LimitCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  std::optional<double> distance;  ///< left out: no limit
  bool relative = false;
};

Expected<void> execute(const LimitCommand& c, Act& act);
void describe(LimitCommand& c, Fields& fields);

}  // namespace knead
