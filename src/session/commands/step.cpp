#include "step.hpp"

#include "../limits.hpp"

namespace knead {

std::span<const Choice> choices(StepAllowance) {
  static constexpr Choice names[] = {
      {"held", StepAllowance::held, "no error if everything that a tool touches is held"}};
  return names;
}

void describe(StepCommand& c, Fields& fields) {
  fields.name("step", "let the selected surfaces evolve under the tools");
  fields.add("count", c.count, {.help = "number of steps"});
  fields.add("lambda", c.lambda, {.help = "for these steps only", .fallback = "that of `evolve`"});
  fields.add("weight", c.weight, {.help = "for these steps only", .fallback = "that of `evolve`"});
  fields.add("allow", c.allow);
}

template <>
Expected<void> Executor::execute(const StepCommand& c) {
  if (auto few = check_steps(c.count, "count", 0); !few) return few;
  EvolutionPolicy evolution = state.evolution;
  if (c.lambda) evolution.lambda = *c.lambda;
  if (c.weight) evolution.weight = *c.weight;
  allow_held = c.allow.has_value();
  return run(c.count, evolution);
}

}  // namespace knead
