#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Other knots for the same control points: the shape changes, for good.
struct KnotsCommand {
  std::string direction;      ///< "u" or "v"
  std::vector<double> knots;  ///< the whole vector, as many as before, on the same domain
};

KNEAD_COMMAND(KnotsCommand, "knots", "other knots for the same control points: the shape changes for good") {
  v.field("direction", Presence::required, c.direction, "u or v");
  v.field("knots", Presence::required, c.knots, "the whole knot vector, as long as before, on the same domain");
}

}  // namespace knead
