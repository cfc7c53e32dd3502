#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Smooths the surface around a point: one step of a plate under tension without a rest shape,
/// everything else held. `strength` is the share of a bump of that radius that is removed.
struct RelaxCommand {
  Fractions at = {0.5, 0.5};
  std::optional<double> radius;  ///< default: a tenth of the diagonal
  double strength = 0.5;
  bool relative = false;
  std::optional<std::string> surface = {};  ///< default: the first selected one
  std::optional<ThroughAllowance> allow = {};
};

Expected<void> execute(const RelaxCommand& c, Act& act);
void describe(RelaxCommand& c, Fields& fields);

}  // namespace knead
