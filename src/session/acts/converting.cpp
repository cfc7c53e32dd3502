#include "converting.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "session/document_regions.hpp"

namespace knead {
namespace {

/// Neighbours are named with the surfaces on which they lie: regions beside the converted ones are
/// found again.
Expected<void> refresh_neighbours(SessionState& state, const std::vector<std::string>& ids) {
  DocumentRegions regions(*state.document);
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const auto& visible = std::as_const(state.surfaces)[k].visible;
    const bool beside =
        visible && std::ranges::any_of(visible->edges, [&](const TrimEdge& edge) {
          return std::ranges::any_of(edge.supports, [&](const std::string& support) {
            return std::ranges::find(ids, id_of_support(support)) != ids.end();
          });
        });
    if (!beside) continue;
    SceneSurface& s = state.surfaces[k];
    auto region = regions.of(s.id);
    if (!region) return std::unexpected(region.error());
    s.visible = std::make_shared<const VisibleRegion>(std::move(*region));
  }
  return {};
}

}  // namespace

std::string id_of_support(const std::string& support) {
  return support.substr(0, support.find(' '));
}

Expected<void> convert_surfaces(Act& act, std::span<const std::string> ids, int order) {
  auto converted = act.document.with_splines(ids);
  if (!converted) return std::unexpected(converted.error());
  act.state.document = std::make_shared<const Document>(*std::move(converted));
  std::vector<std::string> made;
  for (const DocumentSurface& s : act.state.document->surfaces()) {
    if (std::ranges::find(act.state.surfaces, s.id, &SceneSurface::id) != act.state.surfaces.end())
      continue;
    SceneSurface surface = untouched<2>(s.id, s.name, s.unit, s.surface);
    surface.constraints.push_back({TrimHolds{order}, s.surface});
    act.state.surfaces.push_back(std::move(surface));
    made.push_back(s.id);
  }
  if (act.state.surfaces.size() == 1) act.state.selected = 0;
  return refresh_neighbours(act.state, made);
}

}  // namespace knead
