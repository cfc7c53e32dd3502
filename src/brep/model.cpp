#include "knead/brep/model.hpp"

#include <algorithm>
#include <unordered_set>

namespace knead::brep {

Frame frame_about(const Point& origin, const Point& axis) {
  Frame frame{origin};
  frame.z = axis.normalized();
  frame.x = frame.z.unitOrthogonal();
  frame.y = frame.z.cross(frame.x);
  return frame;
}

void Model::index_surfaces() {
  surface_index_.clear();
  for (std::size_t k = 0; k < surfaces.size(); ++k)
    surface_index_.emplace(surfaces[k].id, static_cast<Index>(k));
}

Index Model::surface_index(const std::string& id) const {
  const auto found = surface_index_.find(id);
  return found == surface_index_.end() ? none : found->second;
}

const SplineSurface* Model::find_surface(const std::string& id) const {
  const Index found = surface_index(id);
  return found == none ? nullptr : &surfaces[found];
}

const SplineSurface* Model::spline_under(const Face& face) const {
  if (face.support == none || supports[face.support].spline == none) return nullptr;
  return &surfaces[supports[face.support].spline];
}

std::string Model::label_under(const Face& face) const {
  return face.support == none ? "no surface" : supports[face.support].label();
}

std::string Model::length_unit() const {
  std::vector<std::string> names;
  for (const LengthUnit& unit : units) {
    if (std::ranges::find(names, unit.name) == names.end()) names.push_back(unit.name);
  }
  if (names.empty()) return "unknown";
  std::string result = names.front();
  for (std::size_t k = 1; k < names.size(); ++k) result += ", " + names[k];
  return result;
}

std::unexpected<Error> Model::error(const Record& at, std::string what, std::string remedy) const {
  return std::unexpected(
      Error{ErrorKind::input, std::move(what), at.label(), std::move(remedy), name, at.line});
}

std::vector<Index> edges_around(const Face& face) {
  std::vector<Index> result;
  for (const Bound& bound : face.bounds) {
    for (const EdgeUse& use : bound.edges) result.push_back(use.edge);
  }
  return result;
}

bool Assembly::placed() const {
  return std::ranges::any_of(parts, [](const Part& part) {
    return part.places.size() != 1 || !part.places[0].to_model.matrix().isIdentity(0);
  });
}

const Part* Assembly::part_of(const std::string& surface) const {
  const auto found = std::ranges::find_if(parts, [&](const Part& part) {
    return std::ranges::find(part.surfaces, surface) != part.surfaces.end();
  });
  return found == parts.end() ? nullptr : &*found;
}

void Part::add(const Model& model, Index face) {
  const Face& stored = model.faces[face];
  faces.push_back(stored.id);
  const SplineSurface* below = model.spline_under(stored);
  if (below != nullptr && std::ranges::find(surfaces, below->id) == surfaces.end())
    surfaces.push_back(below->id);
}

void add_rest(const Model& model, Assembly& assembly) {
  std::unordered_set<std::string> held;
  for (const Part& part : assembly.parts) {
    for (const auto* ids : {&part.faces, &part.surfaces, &part.curves})
      held.insert(ids->begin(), ids->end());
  }
  Part rest{{}, model.length_unit(), {}, {}, {}, {PartPlace{}}};
  const auto add = [&](const auto& entities, std::vector<std::string>& ids) {
    for (const auto& entity : entities) {
      if (!held.contains(entity.id)) ids.push_back(entity.id);
    }
  };
  add(model.faces, rest.faces);
  for (const TessellatedItem& item : model.tessellated.items) {
    if (!held.contains(item.mesh.id)) rest.faces.push_back(item.mesh.id);
  }
  add(model.surfaces, rest.surfaces);
  add(model.curves, rest.curves);
  if (!rest.faces.empty() || !rest.surfaces.empty() || !rest.curves.empty())
    assembly.parts.push_back(std::move(rest));
}

Assembly single_part(const Model& model) {
  Assembly result;
  result.unit = model.length_unit();
  add_rest(model, result);
  return result;
}

}  // namespace knead::brep
