#include "coarsen.hpp"

#include <fmt/format.h>

#include <cmath>

#include "session/acts/refining.hpp"
#include "session/acts/selection.hpp"

namespace knead {

void describe(CoarsenCommand& c, Fields& fields) {
  fields.name("coarsen", "remove knots where the shape changes by no more than a tolerance");
  fields.add("tolerance", c.tolerance,
             {.help = "a length",
              .unit = Unit::length,
              .range = at_least(0),
              .presence = Presence::required});
}

Expected<void> execute(const CoarsenCommand& c, Act& act) {
  if (auto surface = selected(act); !surface) return std::unexpected(surface.error());
  for (SceneSurface& s : selected_surfaces(act.state)) {
    const auto result = coarsen(s, c.tolerance);
    if (!result) return std::unexpected(result.error());
    act.state.notes.push_back(
        fmt::format("{}: {} knots removed, the shape moved by less than {:.3g}", s.id,
                    result->removed, result->bound));
    if (result->removed > 0) act.state.notes.push_back(net_note(s));
    if (result->stopped)
      act.state.notes.push_back(
          fmt::format("{}: at rest, as its velocity does not fit the coarser net", s.id));
  }
  return {};
}

}  // namespace knead
