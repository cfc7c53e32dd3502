#include "seams.hpp"

#include <fmt/format.h>

#include "session/acts/act.hpp"

namespace knead {

void describe(SeamsCommand& c, Fields& fields) {
  fields.name("seams", "couple selected surfaces, and each with itself, along shared edges");
  fields.add("couple", c.seams.couple, {.help = "`false`: they may tear apart"});
  fields.add("tolerance", c.seams.tolerance,
             {.help = "how far apart the edges of a seam may be, a length",
              .unit = Unit::length,
              .range = above(0),
              .fallback = "1e-4 of the diagonal of the selected surfaces"});
  fields.add("smooth", c.seams.smooth,
             {.help = "seams that were smooth stay so even where the sides are in no fixed ratio, "
                      "which leaves them less freedom"});
}

Expected<void> execute(const SeamsCommand& c, Act& act) {
  act.state.seams = c.seams;
  return {};
}

}  // namespace knead
