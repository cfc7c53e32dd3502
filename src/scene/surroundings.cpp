#include <algorithm>

#include "brep/trim_loops.hpp"
#include "display.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/brep/model.hpp"

namespace knead {

std::vector<std::shared_ptr<const VisibleRegion>> shown_regions(
    std::span<const SurfaceTrim> trims) {
  std::vector<std::shared_ptr<const VisibleRegion>> result;
  for (const SurfaceTrim& trim : trims) {
    auto& shown = result.emplace_back();
    if (trim.whole) continue;
    VisibleRegion region;
    region.faces = trim.faces;
    shown = std::make_shared<const VisibleRegion>(std::move(region));
  }
  return result;
}

std::shared_ptr<const Surroundings> surroundings(
    const brep::Model& model, std::span<const std::shared_ptr<const VisibleRegion>> visible) {
  constexpr double fine = 2.5e-4;
  auto result = std::make_shared<Surroundings>();
  if (auto faces = context_faces(model, fine)) result->faces = std::move(faces->faces);
  if (const auto& assembly = model.assembly; assembly && assembly->parts.size() > 1) {
    for (std::size_t k = 0; k < assembly->parts.size(); ++k) {
      for (const auto* ids : {&assembly->parts[k].surfaces, &assembly->parts[k].faces}) {
        for (const std::string& id : *ids) result->parts.emplace(id, k);
      }
    }
    // Converted surfaces have the names of what was below their faces.
    for (const brep::OtherSurface& s : brep::other_surfaces(model)) {
      if (!s.faces.empty()) result->parts.emplace(s.id, result->part_of(s.faces.front()));
    }
  }
  const auto senses = face_senses(model);
  for (std::size_t k = 0; k < senses.size(); ++k) {
    result->shown[model.surfaces[k].id] = {k < visible.size() ? visible[k] : nullptr, senses[k]};
  }
  return result;
}

}  // namespace knead
