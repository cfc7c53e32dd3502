#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Lets the selected surfaces evolve under the tools.
struct StepCommand {
  int count = 1;
  std::optional<double> lambda;  ///< default: that of `evolve`
  std::optional<StepWeight> weight;
};

KNEAD_COMMAND(StepCommand, "step", "let the selected surfaces evolve under the tools") {
  v.field("count", Presence::optional, c.count, "number of steps");
  v.field("lambda", Presence::optional, c.lambda, "acm: inverse step size >= 0; default: that of `evolve`, at first 1");
  v.choice("weight", c.weight, std::span<const Choice<StepWeight>>(step_weights),
           "acm: default: that of `evolve`, at first mass");
}

}  // namespace knead
