#include <algorithm>

#include "document_regions.hpp"
#include "info_values.hpp"
#include "knead/session/session_info.hpp"
#include "scene/trims.hpp"

namespace knead {

void describe(EdgeInfo& e, Fields& fields) {
  fields.name("edge info", "An edge of a face.");
  fields.add("id", e.id);
  fields.add("faces", e.faces, {.help = "that meet there"});
  fields.add("deviation", e.deviation,
             {.help = "of the surface from its original position, the largest along the edge; 0 of "
                      "one that moves with its faces",
              .unit = Unit::length});
}

void describe(EdgesInfo& e, Fields& fields) {
  fields.name("edges info", "The edges of the faces on a surface that has moved.");
  fields.add("surface", e.surface, {.help = "its id"});
  fields.add("tolerance", e.tolerance,
             {.help = "within which faces meet, according to the file", .unit = Unit::length});
  fields.add("edges", e.edges);
  fields.add("unknown", e.unknown, {.help = "why they cannot be followed"});
}

namespace {

/// Whether an edge moves with its faces, so that it is where they are.
bool moves_along(const Session& session, const SceneSurface& s, const TrimReport::Edge& edge) {
  const auto& followed = session.state().followed;
  return !may_open(s.constraints, edge.held.id) &&
         (edge.follows ||
          std::ranges::find(followed, edge.held.id, &FollowedEdge::id) != followed.end());
}

}  // namespace

std::vector<EdgesInfo> edges_info(const Session& session) {
  std::vector<EdgesInfo> infos;
  DocumentRegions regions(session.document());
  for (std::size_t k = 0; k < session.state().surfaces.size(); ++k) {
    SceneSurface s = session.state().surfaces[k];
    if (session.moved_control_points(static_cast<int>(k)) == 0) continue;
    Expected<void> known;
    if (!s.visible) {
      if (auto region = regions.of(s.id)) {
        s.visible = std::make_shared<const VisibleRegion>(std::move(*region));
      } else {
        known = std::unexpected(region.error());
      }
    }
    if (s.visible && s.visible->edges.empty()) continue;
    EdgesInfo& info = infos.emplace_back();
    info.surface = s.id;
    const auto report =
        known ? trim_report(s) : Expected<TrimReport>(std::unexpected(known.error()));
    if (!report) {
      info.unknown = report.error().message();
      continue;
    }
    info.tolerance = trim_tolerance(*s.opened, *s.visible);
    for (const TrimReport::Edge& edge : report->edges) {
      const double deviation = moves_along(session, s, edge) ? 0 : edge.deviation;
      info.edges.push_back({edge.held.id, edge.neighbours, deviation});
    }
  }
  return infos;
}

std::string edge_distance_json(const Session& session, std::size_t surface) {
  const SceneSurface& s = session.state().surfaces[surface];
  std::shared_ptr<const VisibleRegion> region = s.visible;
  if (!region) {
    if (auto found = DocumentRegions(session.document()).of(s.id))
      region = std::make_shared<const VisibleRegion>(std::move(*found));
  }
  if (!region || region->edges.empty()) return "null";
  const auto middle = visible_middle(*s.current, *region);
  return middle ? json_of(middle->distance) : "null";
}

}  // namespace knead
