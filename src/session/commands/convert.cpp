#include "convert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "knead/brep/face_conversion.hpp"
#include "session/acts/selection.hpp"
#include "session/acts/trimming.hpp"
#include "session/document_regions.hpp"

namespace knead {
namespace {

/// The id of the surface in "#12 PLANE".
std::string id_of(const std::string& support) { return support.substr(0, support.find(' ')); }

/// The surfaces of other forms that meet the selected ones; those that cannot be converted are
/// noted.
Expected<std::vector<std::string>> neighbours(Act& act) {
  if (auto surface = selected(act); !surface) return std::unexpected(surface.error());
  std::vector<std::string> result;
  const brep::Model* const model = act.document.model();
  const auto others =
      model == nullptr ? std::vector<brep::OtherSurface>() : brep::other_surfaces(*model);
  for (const int k : act.state.selection()) {
    const auto region = visible(act, act.state.surfaces[static_cast<std::size_t>(k)]);
    if (!region) return std::unexpected(region.error());
    for (const TrimEdge& edge : (*region)->edges) {
      for (const std::string& support : edge.supports) {
        const std::string id = id_of(support);
        if (std::ranges::find(others, id, &brep::OtherSurface::id) == others.end()) continue;
        if (std::ranges::find(result, id) == result.end()) result.push_back(id);
      }
    }
  }
  std::erase_if(result, [&](const std::string& id) {
    const auto made = brep::exact_spline(*model, id);
    if (!made)
      act.state.notes.push_back(fmt::format("{} stays as it is: {}", id, made.error().what));
    return !made;
  });
  if (result.empty()) {
    return input_error(
        "the selected surfaces have no neighbour that could be converted", "neighbours",
        "their faces meet B-spline surfaces only, or what the notes of `knead info --faces` say");
  }
  return result;
}

/// Neighbours are named with the surfaces on which they lie: regions beside the converted ones are
/// found again.
Expected<void> refresh_neighbours(SessionState& state, const std::vector<std::string>& ids) {
  DocumentRegions regions(*state.document);
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const auto& visible = std::as_const(state.surfaces)[k].visible;
    const bool beside =
        visible && std::ranges::any_of(visible->edges, [&](const TrimEdge& edge) {
          return std::ranges::any_of(edge.supports, [&](const std::string& support) {
            return std::ranges::find(ids, id_of(support)) != ids.end();
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

/// The order at which the edges of the first selected surface are held; 0 where it holds none.
int order_of_holds(const SessionState& state) {
  int order = 0;
  if (!state.selected) return order;
  for (const KeptConstraint& kept :
       state.surfaces[static_cast<std::size_t>(*state.selected)].constraints) {
    if (const auto* holds = std::get_if<TrimHolds>(&kept.constraint))
      order = std::max(0, holds->order);
  }
  return order;
}

}  // namespace

void describe(ConvertCommand& c, Fields& fields) {
  fields.name("convert",
              "make planes, cylinders and the like exact B-spline surfaces that can be sculpted");
  fields.add("surface", c.surface,
             {.help = "id of the surface, or of a face on it, as `knead info --faces` lists them; "
                      "this, `surfaces` or `neighbours`"});
  fields.add("surfaces", c.surfaces, {.help = "several of them"});
  fields.add("neighbours", c.neighbours, {.help = "all that meet faces on the selected surfaces"});
}

Expected<void> execute(const ConvertCommand& c, Act& act) {
  std::vector<std::string> ids = c.surfaces.value_or(std::vector<std::string>{});
  if (c.surface) ids.insert(ids.begin(), *c.surface);
  if (c.neighbours) {
    const auto beside = neighbours(act);
    if (!beside) return std::unexpected(beside.error());
    ids.insert(ids.end(), beside->begin(), beside->end());
  }
  if (ids.empty()) {
    return input_error("the field is missing", "surface",
                       R"(give "surface", "surfaces" or "neighbours":true)");
  }
  auto converted = act.document.with_splines(ids);
  if (!converted) return std::unexpected(converted.error());
  act.state.document = std::make_shared<const Document>(*std::move(converted));
  const int order = order_of_holds(act.state);
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
