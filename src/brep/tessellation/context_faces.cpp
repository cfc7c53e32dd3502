#include "context_faces.hpp"

#include <array>

#include "face_tessellator.hpp"

namespace knead {

using namespace brep;

Expected<FaceMeshes> context_faces(const brep::Model& model, double chord) {
  if (!(chord >= 1e-6 && chord <= 0.2)) {
    return std::unexpected(
        Error{ErrorKind::usage, "the tolerance of chords is out of range", {}, "use 1e-6 to 0.2"});
  }
  FaceTessellator tessellator(model, {chord});
  FaceMeshes result;
  std::vector<FaceOnSurface> ready;
  for (const Face& face : model.faces) {
    if (model.spline_under(face) != nullptr) continue;
    if (auto on = tessellator.face_on_surface(face))
      ready.push_back(*std::move(on));
    else
      result.skipped.push_back({face.id, std::move(on.error())});
  }
  auto meshes = tessellator.meshes(ready);
  for (std::size_t k = 0; k < ready.size(); ++k) {
    if (meshes[k])
      result.faces.push_back(*std::move(meshes[k]));
    else
      result.skipped.push_back({ready[k].face->id, std::move(meshes[k].error())});
  }
  for (const TessellatedItem& item : model.tessellated.items) result.faces.push_back(item.mesh);
  const std::vector<SkippedFace>& torn = model.tessellated.skipped;
  result.skipped.insert(result.skipped.end(), torn.begin(), torn.end());
  return result;
}

std::vector<int> face_senses(const brep::Model& model) {
  std::vector<std::array<bool, 2>> found(
      model.surfaces.size());  // faces against each surface, along it
  for (const Face& face : model.faces) {
    if (face.support == none || model.supports[face.support].spline == none) continue;
    found[model.supports[face.support].spline][face.sense() > 0 ? 1 : 0] = true;
  }
  std::vector<int> senses;
  for (const auto& [against, along] : found) senses.push_back((along ? 1 : 0) - (against ? 1 : 0));
  return senses;
}

}  // namespace knead
