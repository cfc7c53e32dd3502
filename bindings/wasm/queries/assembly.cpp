// The parts of a file.
#include <unordered_map>
#include <unordered_set>

#include "knead/brep/face_conversion.hpp"
#include "knead/brep/model.hpp"
#include "query.hpp"

namespace knead::studio {
namespace {

struct PartPlace {
  std::string path;
  std::vector<double> matrix;
};

void describe(PartPlace& p, Fields& fields) {
  fields.name("part place", "One place where an assembly puts a part.");
  fields.add("path", p.path, {.help = "products from the model down: engine/valve/spring"});
  fields.add("matrix", p.matrix,
             {.help = "from the part's coordinates to the model's: three rows of four"});
}

struct PartAnswer {
  std::string name, unit;
  std::vector<std::string> surfaces, faces, curves;
  std::vector<PartPlace> places;
};

void describe(PartAnswer& p, Fields& fields) {
  fields.name("part", "Geometry with coordinates of its own.");
  fields.add("name", p.name);
  fields.add("unit", p.unit);
  fields.add("surfaces", p.surfaces, {.help = "ids of its surfaces, those of grey faces too"});
  fields.add("faces", p.faces, {.help = "ids"});
  fields.add("curves", p.curves, {.help = "ids of those that stand for themselves"});
  fields.add("places", p.places, {.help = "at least one"});
}

struct Assembly {
  std::string unit;
  std::vector<PartAnswer> parts;
  std::vector<std::string> warnings;
};

void describe(Assembly& a, Fields& fields) {
  fields.name("assembly", "The parts of a file, and where they stand.");
  fields.add("unit", a.unit);
  fields.add("parts", a.parts);
  fields.add("warnings", a.warnings, {.help = "what could not be followed"});
}

PartPlace place_of(const brep::PartPlace& place) {
  PartPlace to{place.path, {}};
  for (int k = 0; k < 12; ++k) to.matrix.push_back(place.to_model.matrix()(k / 4, k % 4));
  return to;
}

Expected<std::optional<Assembly>> assembly(Session& session) {
  const brep::Model* model = session.document().model();
  if (model == nullptr || model->instances.empty()) return std::nullopt;
  const auto& assembly = model->assembly;
  if (!assembly) return Assembly{"", {}, {assembly.error().message()}};
  std::unordered_map<std::string, std::string> below;  // of faces on other surfaces than splines
  for (const brep::OtherSurface& surface : brep::other_surfaces(*model)) {
    for (const std::string& face : surface.faces) below[face] = surface.id;
  }
  Assembly answer{assembly->unit, {}, assembly->warnings};
  for (const brep::Part& part : assembly->parts) {
    PartAnswer& to = answer.parts.emplace_back(
        PartAnswer{part.name, part.unit, part.surfaces, part.faces, part.curves, {}});
    std::unordered_set<std::string> known;
    for (const std::string& face : part.faces) {
      const auto on = below.find(face);
      if (on != below.end() && known.insert(on->second).second) to.surfaces.push_back(on->second);
    }
    for (const brep::PartPlace& place : part.places) to.places.push_back(place_of(place));
  }
  return answer;
}

}  // namespace

std::vector<Query> assembly_queries() {
  return {query<std::optional<Assembly>, assembly>(
      "assembly", "The parts of the file and where they stand; null without assemblies.")};
}

}  // namespace knead::studio
