#pragma once

#include "../command_fields.hpp"

namespace knead {

/// A condition that a step may ignore: that everything a tool touches is held.
enum class StepAllowance { held };

std::span<const Choice> choices(StepAllowance);

/// Lets the selected surfaces evolve under the tools.
struct StepCommand {
  int count = 1;
  std::optional<double> lambda;  ///< default: that of `evolve`
  std::optional<StepWeight> weight;
  std::optional<StepAllowance> allow = {};
  std::optional<int> increments = {};  ///< of a shell; default: 1
};

template <>
Expected<void> Executor::execute(const StepCommand& c);
void describe(StepCommand& c, Fields& fields);

}  // namespace knead
