#include "freeze.hpp"

#include <fmt/format.h>

#include "scene/places.hpp"
#include "session/acts/holding.hpp"
#include "session/acts/selection.hpp"

namespace knead {

void describe(FreezeCommand& c, Fields& fields) {
  fields.name("freeze", "hold a region, rounded outward to whole knot spans");
  fields.add("region", c.freeze.region,
             {.help = "`[[s0, s1], [t0, t1]]`",
              .unit = Unit::fraction,
              .range = between(0, 1),
              .presence = Presence::required});
}

Expected<void> execute(const FreezeCommand& c, Act& act) {
  auto surface = selected(act);
  if (!surface) return std::unexpected(surface.error());
  if (auto status = add_constraint(act, c.freeze); !status) return status;
  const auto region = region_at(*(*surface)->rest, c.freeze.region);
  ConstraintList list((*surface)->rest->size());
  const auto frozen = freeze_region(*(*surface)->rest, (*region)[0], (*region)[1], list);
  if (!frozen) return std::unexpected(frozen.error());
  act.state.notes.push_back(
      fmt::format("{}: frozen from u = {:.6g} to {:.6g}, v = {:.6g} to {:.6g}", (*surface)->id,
                  frozen->u.lower, frozen->u.upper, frozen->v.lower, frozen->v.upper));
  return {};
}

}  // namespace knead
