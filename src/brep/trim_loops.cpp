#include "trim_loops.hpp"

#include <unordered_map>

#include "boundary_curve.hpp"
#include "face_region.hpp"

namespace knead {

using namespace brep;

Expected<TrimLoops> trim_loops(const brep::Model& model, double chord) {
  if (!(chord >= 1e-6 && chord <= 0.2)) {
    return std::unexpected(
        Error{ErrorKind::usage, "the tolerance of chords is out of range", {}, "use 1e-6 to 0.2"});
  }
  TrimLoops result;
  result.surfaces.resize(model.surfaces.size());
  EdgeSampler edges(model, {chord});
  std::unordered_map<Index, Expected<SurfaceFoot>> feet;
  std::vector<bool> failed(model.surfaces.size(), false);
  for (const Face& face : model.faces) {
    const SplineSurface* const surface = model.spline_under(face);
    if (surface == nullptr || !surface->trimmed) continue;
    const Index k = model.supports[face.support].spline;
    auto foot = feet.find(k);
    if (foot == feet.end()) foot = feet.emplace(k, SurfaceFoot::create(surface->surface)).first;
    auto parts = foot->second
                     ? region_of(model, face, edges, *foot->second,
                                 net_diagonal(surface->surface.control_points()))
                     : Expected<std::vector<RegionPart>>(std::unexpected(foot->second.error()));
    if (!parts) {
      failed[k] = true;
      result.skipped.push_back({face.id, std::move(parts.error())});
      continue;
    }
    for (const RegionPart& part : *parts)
      add_turns(part, foot->second->space(), result.surfaces[k].faces);
  }
  for (std::size_t k = 0; k < result.surfaces.size(); ++k) {
    auto& trim = result.surfaces[k];
    if (failed[k]) trim.faces.clear();
    trim.whole = trim.faces.empty();
  }
  return result;
}

}  // namespace knead
