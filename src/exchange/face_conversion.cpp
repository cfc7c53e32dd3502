#include "knead/exchange/face_conversion.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "covered_part.hpp"
#include "step_data.hpp"
#include "step_faces.hpp"
#include "step_surfaces.hpp"
#include "step_surgeon.hpp"
#include "step_units.hpp"

namespace knead::step {
namespace {

bool is_other(const Reader& reader, const Face& face) {
  return face.surface != no_instance && !is_b_spline_surface(reader, face.surface);
}

std::string form_of(const Reader& reader, std::uint32_t surface) {
  const std::string label = reader.label(surface);
  return label.substr(label.find(' ') + 1);
}

/// The faces on the surface with this id, or on that of the face with this id.
Expected<std::vector<Face>> faces_on(const Reader& reader, const std::string& id) {
  std::uint32_t surface = no_instance;
  bool spline = false, without = false;
  const std::vector<Face> all = read_faces(reader);
  for (const Face& face : all) {
    const bool is_face = name_of(reader, face.instance) == id;
    if (is_face && face.surface == no_instance) without = true;
    if (face.surface == no_instance || (!is_face && name_of(reader, face.surface) != id)) continue;
    surface = face.surface;
    spline = !is_other(reader, face);
  }
  if (spline) return input_error("it lies on a B-spline surface already", id, "select " + name_of(reader, surface));
  if (without) return input_error("the face has no surface", id, "only faces with a surface can be converted");
  if (surface == no_instance) {
    return input_error("no face, and no surface on which one lies, has this name", id,
                       "`knead info --faces` lists those that can be converted");
  }
  std::vector<Face> result;
  std::ranges::copy_if(all, std::back_inserter(result), [&](const Face& face) { return face.surface == surface; });
  return result;
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
    const SurfaceEntity* read = after->find_surface(id);
    return read != nullptr && read->surface.knots() == surface.knots() &&
           same_bits(read->surface.control_points(), surface.control_points()) &&
           same_bits(read->surface.weights(), surface.weights());
  };
  for (const auto& [id, surface] : made) {
    if (!same(id, surface)) return broken(id);
  }
  for (const SurfaceEntity& s : before.surfaces()) {
    if (!same(s.id, s.surface)) return broken(s.id);
  }
  return after;
}

}  // namespace

std::vector<OtherSurface> other_surfaces(const File& file) {
  const Reader reader(file.data().records);
  std::vector<OtherSurface> result;
  std::map<std::uint32_t, std::size_t> known;
  for (const Face& face : read_faces(reader)) {
    if (!is_other(reader, face)) continue;
    const auto [at, fresh] = known.emplace(face.surface, result.size());
    if (fresh) result.push_back({name_of(reader, face.surface), form_of(reader, face.surface), {}});
    result[at->second].faces.push_back(name_of(reader, face.instance));
  }
  return result;
}

std::vector<std::string> surfaces_at_edge(const File& file, const std::string& edge) {
  const Reader reader(file.data().records);
  std::vector<std::string> result;
  for (const Face& face : read_faces(reader)) {
    if (face.surface == no_instance) continue;
    const auto edges = edges_around(reader, face);
    const std::string surface = name_of(reader, face.surface);
    const bool meets = std::ranges::any_of(edges, [&](std::uint32_t k) { return name_of(reader, k) == edge; });
    if (meets && std::ranges::find(result, surface) == result.end()) result.push_back(surface);
  }
  return result;
}

Expected<Surface> exact_spline(const File& file, const std::string& id) {
  const Reader reader(file.data().records);
  const auto faces = faces_on(reader, id);
  if (!faces) return std::unexpected(faces.error());
  return spline_of_faces(reader, *faces, uncertainties_of(reader, {faces->front().surface}).front());
}

std::vector<Expected<Surface>> exact_splines(const File& file) {
  const Reader reader(file.data().records);
  std::vector<std::uint32_t> surfaces;
  std::map<std::uint32_t, std::vector<Face>> faces_on;
  for (const Face& face : read_faces(reader)) {
    if (!is_other(reader, face)) continue;
    auto& faces = faces_on[face.surface];
    if (faces.empty()) surfaces.push_back(face.surface);
    faces.push_back(face);
  }
  const auto uncertainties = uncertainties_of(reader, surfaces);
  std::vector<Expected<Surface>> result;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    result.push_back(spline_of_faces(reader, faces_on[surfaces[k]], uncertainties[k]));
  }
  return result;
}

Expected<File> with_splines(const File& file, std::span<const std::string> surfaces) {
  const Part21File& records = file.data().records;
  const Reader reader(records);
  Surgeon surgeon(records);
  std::map<std::string, Surface> made;
  std::set<std::uint32_t> converted, edges;
  for (const std::string& id : surfaces) {
    const auto faces = faces_on(reader, id);
    if (!faces) return std::unexpected(faces.error());
    const std::uint32_t instance = faces->front().surface;
    if (!converted.insert(instance).second) continue;
    auto surface = spline_of_faces(reader, *faces, uncertainties_of(reader, {instance}).front());
    if (!surface) return std::unexpected(surface.error());
    surgeon.become_spline(instance, *surface);
    for (const Face& face : *faces) {
      surgeon.lie_on(face.instance, instance);
      for (const std::uint32_t edge : edges_around(reader, face)) edges.insert(edge);
    }
    made.emplace(name_of(reader, instance), *std::move(surface));
  }
  if (made.empty()) return file;
  for (const std::uint32_t edge : edges) surgeon.drop_parameter_curves(edge, converted);
  return checked(surgeon.result(), file, made);
}

}  // namespace knead::step
