#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "knead/base/error_code.hpp"
#include "knead/spline/evaluate.hpp"
#include "scene/model/smooth_seams.hpp"
#include "stepping.hpp"

namespace knead {
namespace {

struct Kink {
  double angle = 0;  ///< radians
  Point at = Point::Zero();
};

/// The largest angle between tangent planes at the points of a seam, whichever way their normals
/// point.
/// At the same points that `smooth_seam_edge` would put conditions on.
Expected<Kink> kink_along(std::span<const Surface* const> shapes, const CoupledEdge& edge) {
  Kink kink;
  for (const SharedPoint& point : edge.points) {
    std::array<Point, 2> normals;
    Point at = Point::Zero();
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& [patch, u] = point[side];
      Parameters<2> here(1, 2);
      here << u[0], u[1];
      const auto jet = evaluate<2>(*shapes[static_cast<std::size_t>(patch)], here, 1);
      if (!jet) return std::unexpected(jet.error());
      const Point su = jet->at({1, 0}).row(0), sv = jet->at({0, 1}).row(0);
      normals[side] = su.cross(sv).stableNormalized();
      at = jet->points().row(0);
    }
    const double angle =
        std::atan2(normals[0].cross(normals[1]).norm(), std::abs(normals[0].dot(normals[1])));
    if (angle > kink.angle) kink = {angle, at};
  }
  return kink;
}

}  // namespace

/// Says which seams were smooth and are not any more, why, and what keeps them so.
void note_creases(Act& act, std::span<const SeamReport> seams) {
  std::vector<const Surface*> shapes, references;
  const std::vector<int> selection = act.state.selection();
  for (int k : selection) {
    shapes.push_back(act.state.surfaces[static_cast<std::size_t>(k)].current.get());
    references.push_back(act.state.surfaces[static_cast<std::size_t>(k)].reference.get());
  }
  for (const SeamReport& report : seams) {
    if (!may_crease(report)) continue;
    const auto name = [&](const PatchEdge& side) {
      const auto index = static_cast<std::size_t>(selection[static_cast<std::size_t>(side.patch)]);
      return fmt::format("{} {}", act.state.surfaces[index].id, edge_name(side.edge));
    };
    const std::string begin =
        fmt::format("the seam {} – {} was smooth", name(report.seam.a), name(report.seam.b));
    std::erase_if(act.state.notes,
                  [&](const std::string& note) { return note.starts_with(begin); });
    const auto edge = smooth_seam_edge(references, report.seam);
    const auto kink = edge ? kink_along(shapes, *edge) : std::unexpected(edge.error());
    if (!kink || kink->angle <= accepted_angle) continue;
    const std::string why =
        report.reason.starts_with("C0: ") ? report.reason.substr(4) : report.reason;
    const Diagnostic crease{ErrorCode::seam_creased,
                            {{"first", name(report.seam.a)},
                             {"second", name(report.seam.b)},
                             {"angle", kink->angle * 180 / std::numbers::pi},
                             {"x", kink->at.x()},
                             {"y", kink->at.y()},
                             {"z", kink->at.z()},
                             {"reason", why}}};
    act.state.notes.emplace_back(
        fmt::format(R"({} and has a crease of {:.2g} degrees now at ({:.6g}, {:.6g}, )"
                    R"({:.6g}): it keeps its position only, )"
                    R"(as {}; undo and let it stay smooth with {{"do":"seams","smooth":true}})",
                    begin, kink->angle * 180 / std::numbers::pi, kink->at.x(), kink->at.y(),
                    kink->at.z(), why),
        crease);
  }
}

}  // namespace knead
