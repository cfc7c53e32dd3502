#include "limit.hpp"

#include <fmt/format.h>

#include <cmath>

#include "knead/base/error_code.hpp"
#include "knead/spline/extremum.hpp"
#include "session/acts/selection.hpp"

namespace knead {

void describe(LimitCommand& c, Fields& fields) {
  fields.name("limit", "limit the displacement of every point from the surface as opened");
  fields.add("distance", c.distance,
             {.help = "a length", .unit = Unit::length, .range = above(0), .fallback = "no limit"});
  fields.add("relative", c.relative, {.help = "`distance` is a fraction of the diagonal"});
}

Expected<void> execute(const LimitCommand& c, Act& act) {
  if (!c.distance) {
    act.state.limit.reset();
    return {};
  }
  for (const SceneSurface& s : act.state.surfaces) {
    if (same_basis(*s.opened, *s.current)) continue;
    return input_error(
        fmt::format(
            "weights or knots of {} were edited, and a limit is measured on those it was opened "
            "with",
            s.id),
        "limit", "save the file and open it again, or undo those edits",
        {ErrorCode::limit_needs_opened_basis, {{"surface", s.id}}});
  }
  double unit = 1;
  if (c.relative) {
    const auto length = diagonal(act);
    if (!length) return std::unexpected(length.error());
    unit = *length;
  }
  act.state.limit = *c.distance * unit;
  return {};
}

}  // namespace knead
