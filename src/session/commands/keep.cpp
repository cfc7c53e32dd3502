#include "keep.hpp"

#include "session/acts/holding.hpp"

namespace knead {

void describe(KeepCommand& c, Fields& fields) {
  fields.name("keep", "hold a curve of the surface");
  fields.add("u", c.keep.u,
             {.help = "the line u = const at this fraction of the domain, exactly",
              .unit = Unit::fraction,
              .range = between(0, 1)});
  fields.add("v", c.keep.v,
             {.help = "the line v = const", .unit = Unit::fraction, .range = between(0, 1)});
  fields.add("curve", c.keep.curve,
             {.help = "`[[s, t], …]`, a polyline in the domain, to the tolerance",
              .unit = Unit::fraction,
              .range = between(0, 1)});
  fields.add("tolerance", c.keep.tolerance,
             {.help = "of a polyline: it moves by no more than this share of the motion around it",
              .range = {.least = 0, .most = 1, .open_below = true}});
}

Expected<void> execute(const KeepCommand& c, Act& act) {
  const int ways = static_cast<int>(c.keep.u.has_value()) + static_cast<int>(c.keep.v.has_value()) +
                   static_cast<int>(!c.keep.curve.empty());
  if (ways != 1) {
    return input_error("one of u, v and curve is needed", "keep", "give exactly one of them");
  }
  return add_constraint(act, c.keep);
}

}  // namespace knead
