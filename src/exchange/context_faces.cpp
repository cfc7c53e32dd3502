#include "knead/exchange/context_faces.hpp"

#include <unordered_map>
#include <unordered_set>

#include "face_tessellator.hpp"

namespace knead {

using namespace step;

Expected<FaceMeshes> context_faces(const step::File& file, double chord) {
  if (!(chord >= 1e-6 && chord <= 0.2)) {
    return std::unexpected(Error{ErrorKind::usage, "the tolerance of chords is out of range", {}, "use 1e-6 to 0.2"});
  }
  const step::File::Data& data = file.data();
  const std::unordered_set<std::uint32_t> drawn(data.surface_instances.begin(), data.surface_instances.end());
  FaceTessellator tessellator(data, {chord});
  const Reader& reader = tessellator.reader();
  FaceMeshes result;
  for (const Face& face : read_faces(reader)) {
    if (drawn.contains(face.surface)) continue;
    const auto on_surface = tessellator.face_on_surface(face);
    auto mesh = on_surface ? tessellator.mesh(*on_surface) : std::unexpected(on_surface.error());
    if (mesh)
      result.faces.push_back(*std::move(mesh));
    else
      result.skipped.push_back({name_of(reader, face.instance), std::move(mesh.error())});
  }
  return result;
}

std::vector<int> face_senses(const step::File& file) {
  const step::File::Data& data = file.data();
  std::unordered_map<std::uint32_t, std::array<bool, 2>> found;  // by surface: faces against it, along it
  for (const Face& face : read_faces(Reader(data.records))) found[face.surface][face.same_sense ? 1 : 0] = true;
  std::vector<int> senses;
  for (const auto instance : data.surface_instances) {
    const auto [against, along] = found[instance];
    senses.push_back((along ? 1 : 0) - (against ? 1 : 0));
  }
  return senses;
}

}  // namespace knead
