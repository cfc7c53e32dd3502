#pragma once

#include "../command_fields.hpp"

namespace knead {

/// No point may be further than this from the surface as opened.
struct LimitCommand {
  std::optional<double> distance;  ///< left out: no limit
  bool relative = false;
};

KNEAD_COMMAND(LimitCommand, "limit", "no point moves further from the surface as opened") {
  v.field("distance", Presence::optional, c.distance, "length; left out: no limit");
  v.field("relative", Presence::optional, c.relative,
          "a fraction of the surface's bounding-box diagonal, not a length");
}

}  // namespace knead
