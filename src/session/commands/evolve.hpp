#pragma once

#include "../command_fields.hpp"

namespace knead {

/// What steps do; "static" solves at once.
struct EvolveCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  EvolutionPolicy evolution;
};

std::span<const Choice> choices(ForceRoute);

std::span<const Choice> choices(Evolution);

std::span<const Choice> choices(StepAccuracy);
std::span<const Choice> choices(StepSolver);

Expected<void> execute(const EvolveCommand& c, Act& act);
void describe(EvolveCommand& c, Fields& fields);

}  // namespace knead
