#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Whether knot lines of full multiplicity are kept from bending, and poles from tearing.
struct SmoothCommand {
  bool knot_lines = true;
  bool poles = true;
};

KNEAD_COMMAND(SmoothCommand, "smooth", "keep what is smooth smooth; on unless switched off") {
  v.field("knot_lines", Presence::optional, c.knot_lines, "no creases at knots of full multiplicity");
  v.field("poles", Presence::optional, c.poles, "edges that are a point keep their tangent plane");
}

}  // namespace knead
