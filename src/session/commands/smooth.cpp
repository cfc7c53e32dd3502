#include "smooth.hpp"

#include "session/acts/selection.hpp"

namespace knead {

void describe(SmoothCommand& c, Fields& fields) {
  fields.name("smooth", "keep smooth knot lines and poles smooth; on by default");
  fields.add(
      "knot_lines", c.knot_lines,
      {.help = "no hinges at knots of full multiplicity (the quadrants of every CAD cylinder)"});
  fields.add("poles", c.poles, {.help = "edges collapsed to a point keep their tangent plane"});
}

Expected<void> execute(const SmoothCommand& c, Act& act) {
  if (auto surface = selected(act); !surface) return std::unexpected(surface.error());
  for (SceneSurface& s : selected_surfaces(act.state)) {
    s.smooth_knot_lines = c.knot_lines;
    s.smooth_poles = c.poles;
  }
  return {};
}

}  // namespace knead
