#include "evolve.hpp"

#include <fmt/format.h>

#include <cmath>

namespace knead {

template <>
Expected<void> Executor::execute(const EvolveCommand& c) {
  if (!(std::isfinite(c.evolution.lambda) && c.evolution.lambda >= 0)) {
    return input_error(fmt::format("{} is not a step parameter", c.evolution.lambda), "lambda",
                       "use a finite number >= 0");
  }
  if (!(std::isfinite(c.evolution.time_step) && c.evolution.time_step > 0)) {
    return input_error(fmt::format("{} is not a time step", c.evolution.time_step), "time_step",
                       "use a finite number > 0");
  }
  if (c.evolution.mode == Evolution::stationary) {
    if (auto done = run(1, c.evolution); !done) return done;
  }
  state.evolution = c.evolution;
  return {};
}

}  // namespace knead
