#include "modes.hpp"

#include <cmath>
#include <numbers>

#include "scene/model/structural_modes.hpp"
#include "session/acts/limits.hpp"
#include "session/acts/selection.hpp"

namespace knead {

void describe(ModesCommand& c, Fields& fields) {
  fields.name("modes", "report the lowest natural frequencies about the present state");
  fields.add("count", c.count,
             {.help = "number of modes; rigid ones count too", .range = between(1, most_modes)});
}

Expected<void> execute(const ModesCommand& c, Act& act) {
  if (auto chosen = selected(act); !chosen) return std::unexpected(chosen.error());
  auto found = natural_modes(act.state, c.count);
  if (!found) return std::unexpected(found.error());
  act.state.modes.clear();
  for (Eigenmode& mode : *found) {
    const double frequency =
        std::copysign(std::sqrt(std::abs(mode.value)), mode.value) / (2 * std::numbers::pi);
    act.state.modes.push_back({frequency, mode.residual, std::move(mode.shape)});
  }
  return {};
}

}  // namespace knead
