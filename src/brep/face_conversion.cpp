#include "knead/brep/face_conversion.hpp"

#include <algorithm>
#include <map>

#include "covered_part.hpp"

namespace knead::brep {
namespace {

bool is_other(const Model& model, const Face& face) {
  return face.support != none && model.supports[face.support].spline == none;
}

/// Faces on other surfaces than B-splines, by surface, in the order of the first of them.
std::vector<std::vector<const Face*>> faces_on_others(const Model& model) {
  std::vector<std::vector<const Face*>> result;
  std::map<Index, std::size_t> known;
  for (const Face& face : model.faces) {
    if (!is_other(model, face)) continue;
    const auto [at, fresh] = known.emplace(face.support, result.size());
    if (fresh) result.emplace_back();
    result[at->second].push_back(&face);
  }
  return result;
}

}  // namespace

std::vector<OtherSurface> other_surfaces(const Model& model) {
  std::vector<OtherSurface> result;
  for (const auto& faces : faces_on_others(model)) {
    const Support& support = model.supports[faces.front()->support];
    OtherSurface& other = result.emplace_back(support.id, support.kind);
    for (const Face* face : faces) other.faces.push_back(face->id);
  }
  return result;
}

std::vector<std::string> surfaces_at_edge(const Model& model, const std::string& edge) {
  std::vector<std::string> result;
  for (const Face& face : model.faces) {
    if (face.support == none) continue;
    const std::string& surface = model.supports[face.support].id;
    const auto edges = edges_around(face);
    const bool meets =
        std::ranges::any_of(edges, [&](Index k) { return model.edges[k].id == edge; });
    if (meets && std::ranges::find(result, surface) == result.end()) result.push_back(surface);
  }
  return result;
}

Expected<std::vector<const Face*>> faces_on_other(const Model& model, const std::string& id) {
  Index support = none;
  bool spline = false, without = false;
  for (const Face& face : model.faces) {
    const bool is_face = face.id == id;
    if (is_face && face.support == none) without = true;
    if (face.support == none || (!is_face && model.supports[face.support].id != id)) continue;
    support = face.support;
    spline = !is_other(model, face);
  }
  if (spline)
    return input_error("it lies on a B-spline surface already", id,
                       "select " + model.supports[support].id);
  if (without)
    return input_error("the face has no surface", id, "only faces with a surface can be converted");
  if (support == none) {
    return input_error("this face is not in the open file", id,
                       "`knead info --faces` lists those that can be converted");
  }
  std::vector<const Face*> result;
  for (const Face& face : model.faces) {
    if (face.support == support) result.push_back(&face);
  }
  return result;
}

Expected<Surface> exact_spline(const Model& model, const std::string& id) {
  const auto faces = faces_on_other(model, id);
  if (!faces) return std::unexpected(faces.error());
  return spline_of_faces(model, *faces);
}

std::vector<Expected<Surface>> exact_splines(const Model& model) {
  std::vector<Expected<Surface>> result;
  for (const auto& faces : faces_on_others(model)) result.push_back(spline_of_faces(model, faces));
  return result;
}

}  // namespace knead::brep
