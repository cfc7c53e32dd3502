#pragma once

#include "../command_fields.hpp"

namespace knead {

/// What steps do; "static" solves at once.
struct EvolveCommand {
  EvolutionPolicy evolution;
};

inline constexpr Choice<ForceRoute> force_routes[] = {{"gauss", ForceRoute::gauss}, {"analytic", ForceRoute::analytic}};

inline constexpr Choice<Evolution> evolutions[] = {
    {"acm", Evolution::acm}, {"static", Evolution::stationary}, {"dynamic", Evolution::dynamic}};

KNEAD_COMMAND(EvolveCommand, "evolve", "what steps do; static solves at once") {
  v.choice("mode", c.evolution.mode, std::span<const Choice<Evolution>>(evolutions),
           "acm sinks to the balance, static is the balance, dynamic swings");
  v.field("lambda", Presence::optional, c.evolution.lambda, "acm: inverse step size >= 0");
  v.field("time_step", Presence::optional, c.evolution.time_step, "dynamic: time per step");
  v.choice("weight", c.evolution.weight, std::span<const Choice<StepWeight>>(step_weights),
           "acm: W of the step: mass matrix, or identity as in the thesis");
  v.choice("route", c.evolution.route, std::span<const Choice<ForceRoute>>(force_routes),
           "how tool forces are integrated: Gauss points, or Greville abscissae and exact mass matrices");
}

}  // namespace knead
