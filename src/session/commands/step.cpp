#include "step.hpp"

#include <fmt/format.h>

#include "session/acts/limits.hpp"
#include "session/acts/selection.hpp"
#include "session/acts/stepping.hpp"

namespace knead {

std::span<const Choice> choices(StepAllowance) {
  static constexpr Choice names[] = {
      {"held", StepAllowance::held, "no error if everything that a tool touches is held"},
      {"through", StepAllowance::through, "no note if a face comes through another"},
      {"all", StepAllowance::all, "both"},
      {"nothing", StepAllowance::nothing, "it stops where a face would come through another"}};
  return names;
}

void describe(StepCommand& c, Fields& fields) {
  fields.name("step", "let the selected surfaces evolve under the tools");
  fields.add("count", c.count, {.help = "number of steps", .range = between(0, max_steps)});
  fields.add(
      "lambda", c.lambda,
      {.help = "for these steps only", .range = at_least(0), .fallback = "that of `evolve`"});
  fields.add("weight", c.weight, {.help = "for these steps only", .fallback = "that of `evolve`"});
  fields.add("allow", c.allow, {.help = "what it does not stop or warn at"});
  fields.add("increments", c.increments,
             {.help = "of a shell: the load is applied in this many equal parts",
              .range = between(1, max_steps),
              .fallback = "1"});
}

Expected<void> execute(const StepCommand& c, Act& act) {
  EvolutionPolicy evolution = act.state.evolution;
  if (c.lambda) evolution.lambda = *c.lambda;
  if (c.weight) evolution.weight = *c.weight;
  if (act.state.body && c.increments) return of_surfaces(act, "increments");
  const auto made =
      run(act, {.count = c.count,
                .evolution = evolution,
                .increments = c.increments,
                .allow_held = c.allow == StepAllowance::held || c.allow == StepAllowance::all,
                .may_stop = !act.state.body});
  if (!made) return std::unexpected(made.error());
  if (made->stopped) act.steps_kept = made->count;
  return {};
}

}  // namespace knead
