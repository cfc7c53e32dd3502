#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Conditions that a step may ignore: that everything a tool touches is held, that surfaces come
/// through other faces, both; or not even what it may without being asked, to come through.
enum class StepAllowance { held, through, all, nothing };

std::span<const Choice> choices(StepAllowance);

/// Lets the selected surfaces evolve under the tools.
struct StepCommand {
  static constexpr ActsOn acts_on = ActsOn::shapes;
  int count = 1;
  std::optional<double> lambda;  ///< default: that of `evolve`
  std::optional<StepWeight> weight;
  std::optional<StepAllowance> allow = {};
  std::optional<int> increments = {};  ///< of a shell; default: 1
};

Expected<void> execute(const StepCommand& c, Act& act);
void describe(StepCommand& c, Fields& fields);

}  // namespace knead
