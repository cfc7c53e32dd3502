#include <algorithm>
#include <span>

#include "document_regions.hpp"
#include "info_values.hpp"
#include "knead/session/session_info.hpp"
#include "scene/parted_edges.hpp"
#include "scene/trims.hpp"

namespace knead {

void describe(EdgeInfo& e, Fields& fields) {
  fields.name("edge info", "An edge of a face.");
  fields.add("id", e.id);
  fields.add("faces", e.faces, {.help = "that meet there"});
  fields.add("deviation", e.deviation,
             {.help = "of its faces from each other, or from the edge, if that is more than a file "
                      "allows; else 0",
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

/// By how much the faces at an edge are parted, or the edge from them, if by more than they may be.
double parting_of(std::span<const PartedEdge> parted, const std::string& edge) {
  const auto found = std::ranges::find(parted, edge, &PartedEdge::id);
  return found == parted.end() ? 0 : found->distance;
}

}  // namespace

std::vector<EdgesInfo> edges_info(const Session& session) {
  std::vector<EdgesInfo> infos;
  const brep::Model* model = session.document().model();
  if (model == nullptr || model->edges.empty()) return infos;
  const auto parted = session.parted_edges();
  DocumentRegions regions(session.document());
  for (std::size_t k = 0; k < session.state().surfaces.size(); ++k) {
    SceneSurface s = session.state().surfaces[k];
    if (session.moved_control_points(static_cast<int>(k)) == 0) continue;
    Expected<void> known;
    if (!parted) known = std::unexpected(parted.error());
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
    if (!known) {
      info.unknown = known.error().message();
      continue;
    }
    info.tolerance = trim_tolerance(*s.opened, *s.visible);
    for (const TrimEdge& edge : s.visible->edges)
      info.edges.push_back({edge.id, edge.neighbours, parting_of(*parted, edge.id)});
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
