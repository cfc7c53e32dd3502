#include "symmetry.hpp"

#include <fmt/format.h>

#include "knead/hold/constraints.hpp"
#include "refine.hpp"
#include "session/acts/holding.hpp"
#include "session/acts/selection.hpp"

namespace knead {

void describe(SymmetryCommand& c, Fields& fields) {
  fields.name("symmetry", "keep a symmetry");
  fields.add("edge", c.edge,
             {.help = "stays in the plane, the surface perpendicular to it; this or `mirror`"});
  fields.add("mirror", c.mirror,
             {.help = "the direction along which partners lie. An asymmetric net is refined where "
                      "`refine` permits it; otherwise the error says which knots are missing",
              .choices = surface_directions});
  fields.add("point", c.point,
             {.help = "`[x, y, z]` of the plane",
              .unit = Unit::length,
              .fallback = "for `mirror`: of the best plane"});
  fields.add("normal", c.normal,
             {.help = "`[x, y, z]` of the plane", .fallback = "for `mirror`: of the best plane"});
}

Expected<void> execute(const SymmetryCommand& c, Act& act) {
  auto surface = selected(act);
  if (!surface) return std::unexpected(surface.error());
  if (c.edge.has_value() == c.mirror.has_value()) {
    return input_error("one of edge and mirror is needed", "symmetry", "give exactly one of them");
  }
  if (c.edge && !(c.point && c.normal))
    return input_error("the plane is missing", "normal", "give point and normal");
  if (c.mirror && act.state.permission == RefinePermission::automatic) {
    // Exactly the knots that make the net symmetric.
    const int direction = *c.mirror == "u" ? 0 : 1;
    const auto plane = mirror_plane(*(*surface)->reference, direction);
    if (!plane) return std::unexpected(plane.error());
    const auto report = mirror_report(*(*surface)->reference, direction, *plane, 1e-9);
    if (!report) return std::unexpected(report.error());
    if (!report->insert.empty()) {
      RefineCommand refine;
      (direction == 0 ? refine.knots_u : refine.knots_v) = report->insert;
      if (auto status = execute(refine, act); !status) return status;
    }
  }
  std::optional<MirrorPlane> plane;
  if (c.point && c.normal) {
    plane = {Point((*c.point)[0], (*c.point)[1], (*c.point)[2]),
             Point((*c.normal)[0], (*c.normal)[1], (*c.normal)[2])};
  }
  if (c.edge) return add_constraint(act, EdgeSymmetry{*c.edge, *plane});
  return add_constraint(act, MirrorSymmetry{*c.mirror == "u" ? 0 : 1, plane});
}

}  // namespace knead
