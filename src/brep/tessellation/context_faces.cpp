#include "knead/brep/context_faces.hpp"

#include <array>

#include "face_tessellator.hpp"

namespace knead {

using namespace brep;

Expected<FaceMeshes> context_faces(const brep::Model& model, double chord) {
  if (!(chord >= 1e-6 && chord <= 0.2)) {
    return std::unexpected(Error{ErrorKind::usage, "the tolerance of chords is out of range", {}, "use 1e-6 to 0.2"});
  }
  FaceTessellator tessellator(model, {chord});
  FaceMeshes result;
  for (const Face& face : model.faces) {
    if (model.spline_under(face) != nullptr) continue;
    const auto on_surface = tessellator.face_on_surface(face);
    auto mesh = on_surface ? tessellator.mesh(*on_surface) : std::unexpected(on_surface.error());
    if (mesh)
      result.faces.push_back(*std::move(mesh));
    else
      result.skipped.push_back({face.id, std::move(mesh.error())});
  }
  return result;
}

std::vector<int> face_senses(const brep::Model& model) {
  std::vector<std::array<bool, 2>> found(model.surfaces.size());  // faces against each surface, along it
  for (const Face& face : model.faces) {
    if (face.support == none || model.supports[face.support].spline == none) continue;
    found[model.supports[face.support].spline][face.same_sense ? 1 : 0] = true;
  }
  std::vector<int> senses;
  for (const auto& [against, along] : found) senses.push_back((along ? 1 : 0) - (against ? 1 : 0));
  return senses;
}

}  // namespace knead
