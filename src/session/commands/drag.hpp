#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Grips a surface point with a footprint, drags it and lets go.
struct DragCommand {
  Fractions at = {0.5, 0.5};
  Vector3 by = {0, 0, 0};
  std::optional<double> radius;  ///< default: a tenth of the diagonal
  double strength = 1e4;
  int steps = 4;
  double plasticity = 1;
  bool relative = false;
  std::optional<bool> middle = {};          ///< of the visible part, instead of `at`
  std::optional<std::string> surface = {};  ///< default: the first selected one
  std::optional<ThroughAllowance> allow = {};
};

Expected<void> execute(const DragCommand& c, Act& act);
void describe(DragCommand& c, Fields& fields);

}  // namespace knead
