#include "knead/exchange/save_model.hpp"

#include <unordered_map>

#include "brep/tessellation/model_mesh.hpp"

namespace knead {

Expected<ModelFile> save_model(const Source& source, const Format& format, double tolerance,
                               SaveOptions options) {
  const auto model = source.model();
  if (!model) return input_error("the file has no faces", {}, "open a file with faces");
  const auto meshed = model_faces(*model, tolerance);
  if (!meshed) return std::unexpected(meshed.error());
  if (meshed->faces.empty()) {
    const SkippedFace& first = meshed->skipped.front();
    return std::unexpected(
        first.reason.within("none of the faces can be made triangles: " + first.id));
  }
  ModelFile result{{},
                   meshed->faces.size(),
                   0,
                   open_sides(meshed->faces),
                   0,
                   meshed->skipped,
                   model->assembly->warnings};
  options.unit = model->assembly->unit == "unknown" ? "" : model->assembly->unit;
  const auto colours = source.colours();
  std::unordered_map<std::string, std::string> names;  // of tessellated items
  for (const brep::TessellatedItem& item : model->tessellated.items)
    names.emplace(item.mesh.id, item.name);
  std::vector<NamedMesh> meshes;
  for (const FaceMesh& face : meshed->faces) {
    const brep::SplineSurface* entity = model->find_surface(face.surface);
    NamedMesh& mesh = meshes.emplace_back();
    mesh.name = entity != nullptr  ? entity->name
                : face.tessellated ? names[face.id]
                                   : std::string();
    if (mesh.name.empty()) mesh.name = face.id;
    result.tessellated += face.tessellated ? 1 : 0;
    auto colour = colours.find(face.id);
    if (colour == colours.end()) colour = colours.find(face.surface);
    if (colour != colours.end()) mesh.colour = colour->second;
    const auto count = static_cast<Eigen::Index>(face.points.size());
    mesh.points.resize(count, 3);
    mesh.normals.resize(count, 3);
    for (Eigen::Index k = 0; k < count; ++k) {
      mesh.points.row(k) = face.points[static_cast<std::size_t>(k)].transpose();
      mesh.normals.row(k) = face.normals[static_cast<std::size_t>(k)].transpose();
    }
    mesh.triangles = face.triangles;
    result.triangles += mesh.triangles.size();
  }
  auto bytes = save_meshes(meshes, format, options);
  if (!bytes) return std::unexpected(std::move(bytes.error()));
  result.bytes = *std::move(bytes);
  return result;
}

}  // namespace knead
