#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Lets the selected surfaces evolve under the tools.
struct StepCommand {
  int count = 1;
  std::optional<double> lambda;  ///< default: that of `evolve`
  std::optional<StepWeight> weight;
};

template <>
Expected<void> Executor::execute(const StepCommand& c);
void describe(StepCommand& c, Fields& fields);

}  // namespace knead
