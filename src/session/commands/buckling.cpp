#include "buckling.hpp"

#include "scene/model/structural_modes.hpp"
#include "session/acts/limits.hpp"
#include "session/acts/selection.hpp"

namespace knead {

void describe(BucklingCommand& c, Fields& fields) {
  fields.name("buckling", "report the factors of the present loads at which a shell buckles");
  fields.add("count", c.count,
             {.help = "number of factors, the lowest first", .range = between(1, most_modes)});
}

Expected<void> execute(const BucklingCommand& c, Act& act) {
  if (auto chosen = selected(act); !chosen) return std::unexpected(chosen.error());
  auto found = linear_buckling(act.state, c.count);
  if (!found) return std::unexpected(found.error());
  act.state.buckling.clear();
  for (Eigenmode& mode : *found)
    act.state.buckling.push_back({mode.value, mode.residual, std::move(mode.shape)});
  return {};
}

}  // namespace knead
