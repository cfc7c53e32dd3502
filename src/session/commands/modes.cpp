#include "modes.hpp"

#include <cmath>
#include <numbers>

#include "../limits.hpp"
#include "scene/model/structural_modes.hpp"

namespace knead {

void describe(ModesCommand& c, Fields& fields) {
  fields.name("modes", "report the lowest natural frequencies about the present state");
  fields.add("count", c.count, {.help = "number of modes; rigid ones count too"});
}

template <>
Expected<void> Executor::execute(const ModesCommand& c) {
  if (auto chosen = selected(); !chosen) return std::unexpected(chosen.error());
  if (auto few = check_modes(c.count); !few) return few;
  auto found = natural_modes(state, c.count);
  if (!found) return std::unexpected(found.error());
  state.modes.clear();
  for (Eigenmode& mode : *found) {
    const double frequency = std::copysign(std::sqrt(std::abs(mode.value)), mode.value) / (2 * std::numbers::pi);
    state.modes.push_back({frequency, mode.residual, std::move(mode.shape)});
  }
  return {};
}

}  // namespace knead
