#include "knead/exchange/trim_loops.hpp"

#include <unordered_map>

#include "face_region.hpp"
#include "step_data.hpp"
#include "step_surfaces.hpp"

namespace knead {

using namespace step;

Expected<TrimLoops> trim_loops(const step::File& file, double chord) {
  if (!(chord >= 1e-6 && chord <= 0.2)) {
    return std::unexpected(Error{ErrorKind::usage, "the tolerance of chords is out of range", {}, "use 1e-6 to 0.2"});
  }
  const step::File::Data& data = file.data();
  const Reader reader(data.records);
  TrimLoops result;
  result.surfaces.resize(data.surfaces->size());
  std::unordered_map<std::uint32_t, std::size_t> index;
  for (std::size_t k = 0; k < data.surfaces->size(); ++k) {
    if ((*data.surfaces)[k].trimmed) index.emplace(data.surface_instances[k], k);
  }
  EdgeSampler edges(reader, {chord});
  std::unordered_map<std::size_t, Expected<SurfaceFoot>> feet;
  std::vector<bool> failed(data.surfaces->size(), false);
  for (const Face& face : read_faces(reader)) {
    const auto found = index.find(face.surface);
    if (found == index.end()) continue;
    const auto k = found->second;
    auto foot = feet.find(k);
    if (foot == feet.end()) foot = feet.emplace(k, SurfaceFoot::create((*data.surfaces)[k].surface)).first;
    auto parts = foot->second ? region_of(reader, face, edges, *foot->second,
                                          net_diagonal((*data.surfaces)[k].surface.control_points()))
                              : Expected<std::vector<RegionPart>>(std::unexpected(foot->second.error()));
    if (!parts) {
      failed[k] = true;
      result.skipped.push_back(
          {"#" + std::to_string(reader.file().instance(face.instance).id), std::move(parts.error())});
      continue;
    }
    for (const RegionPart& part : *parts) add_turns(part, foot->second->space(), result.surfaces[k].faces);
  }
  for (std::size_t k = 0; k < result.surfaces.size(); ++k) {
    auto& trim = result.surfaces[k];
    if (failed[k]) trim.faces.clear();
    trim.whole = trim.faces.empty();
  }
  return result;
}

}  // namespace knead
