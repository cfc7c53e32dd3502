#include "step.hpp"

#include <fmt/format.h>

namespace knead {

template <>
Expected<void> Executor::execute(const StepCommand& c) {
  if (c.count < 0) return input_error(fmt::format("{} steps cannot be done", c.count), "count", "use 0 or more");
  EvolutionPolicy evolution = state.evolution;
  if (c.lambda) evolution.lambda = *c.lambda;
  if (c.weight) evolution.weight = *c.weight;
  return run(c.count, evolution);
}

}  // namespace knead
