#include "studio_assembly.hpp"

#include <nlohmann/json.hpp>
#include <unordered_map>
#include <unordered_set>

#include "knead/brep/assembly.hpp"
#include "knead/brep/face_conversion.hpp"

namespace knead::studio {
namespace {

using Json = nlohmann::json;

Json places_of(const brep::Part& part) {
  Json places = Json::array();
  for (const brep::PartPlace& place : part.places) {
    Json matrix = Json::array();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) matrix.push_back(place.to_model.matrix()(row, column));
    }
    places.push_back({{"path", place.path}, {"matrix", std::move(matrix)}});
  }
  return places;
}

}  // namespace

std::string assembly_json(const brep::Model& model) {
  if (model.instances.empty()) return "null";
  const auto& assembly = model.assembly;
  if (!assembly) {
    return Json{{"unit", ""}, {"parts", Json::array()}, {"warnings", {assembly.error().message()}}}.dump(
        -1, ' ', false, Json::error_handler_t::replace);
  }
  std::unordered_map<std::string, std::string> below;  // of faces on other surfaces than splines
  for (const brep::OtherSurface& surface : brep::other_surfaces(model)) {
    for (const std::string& face : surface.faces) below[face] = surface.id;
  }
  Json parts = Json::array();
  for (const brep::Part& part : assembly->parts) {
    Json surfaces = part.surfaces;
    std::unordered_set<std::string> known;
    for (const std::string& face : part.faces) {
      const auto on = below.find(face);
      if (on != below.end() && known.insert(on->second).second) surfaces.push_back(on->second);
    }
    parts.push_back({{"name", part.name},
                     {"unit", part.unit},
                     {"surfaces", std::move(surfaces)},
                     {"faces", part.faces},
                     {"curves", part.curves},
                     {"places", places_of(part)}});
  }
  return Json{{"unit", assembly->unit}, {"parts", std::move(parts)}, {"warnings", assembly->warnings}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace knead::studio
