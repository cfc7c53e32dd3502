#include "conversion.hpp"

#include <map>
#include <set>

#include "data.hpp"
#include "exchange/part21/part21_text.hpp"
#include "exchange/step/write/surgeon.hpp"
#include "knead/brep/face_conversion.hpp"

namespace knead::step {
namespace {

/// Of a name that the file has.
std::uint32_t instance_of(const Part21File& records, const std::string& id) {
  return records.find(parse_instance_name(id).value_or(0)).value_or(no_instance);
}

/// Reads the result again: the new surfaces bit for bit, and all others as they were.
Expected<File> checked(std::string bytes, const File& before, const std::map<std::string, Surface>& made) {
  auto after = File::parse(std::move(bytes), before.name());
  const auto broken = [&](const std::string& id) {
    return std::unexpected(Error{ErrorKind::numerical, "internal: the converted file does not read back as it should",
                                 id, "please report this file", before.name(), 0});
  };
  if (!after) return broken(after.error().message());
  const auto same = [&](const std::string& id, const Surface& surface) {
    const brep::SplineSurface* read = after->model().find_surface(id);
    return read != nullptr && read->surface.knots() == surface.knots() &&
           same_bits(read->surface.control_points(), surface.control_points()) &&
           same_bits(read->surface.weights(), surface.weights());
  };
  for (const auto& [id, surface] : made) {
    if (!same(id, surface)) return broken(id);
  }
  for (const brep::SplineSurface& s : before.surfaces()) {
    if (!same(s.id, s.surface)) return broken(s.id);
  }
  return after;
}

}  // namespace

Expected<File> with_splines(const File& file, std::span<const std::string> surfaces) {
  const Part21File& records = file.data().records;
  const brep::Model& model = file.model();
  Surgeon surgeon(records);
  std::map<std::string, Surface> made;
  std::set<std::uint32_t> converted, edges;
  for (const std::string& id : surfaces) {
    const auto faces = brep::faces_on_other(model, id);
    if (!faces) return std::unexpected(faces.error());
    const std::string& name = model.supports[faces->front()->support].id;
    const std::uint32_t instance = instance_of(records, name);
    if (!converted.insert(instance).second) continue;
    auto surface = brep::exact_spline(model, name);
    if (!surface) return std::unexpected(surface.error());
    surgeon.become_spline(instance, *surface);
    for (const brep::Face* face : *faces) {
      surgeon.lie_on(instance_of(records, face->id), instance);
      for (const brep::Index edge : brep::edges_around(*face)) edges.insert(instance_of(records, model.edges[edge].id));
    }
    made.emplace(name, *std::move(surface));
  }
  if (made.empty()) return file;
  for (const std::uint32_t edge : edges) surgeon.drop_parameter_curves(edge, converted);
  return checked(surgeon.result(), file, made);
}

}  // namespace knead::step
