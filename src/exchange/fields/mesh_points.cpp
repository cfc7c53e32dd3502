#include "mesh_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "line_reader.hpp"
#include "point_fields.hpp"

namespace knead::fields {
namespace {

Expected<Point> point_of(std::span<const std::string_view> words, std::string_view file, int line) {
  Point result;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto value = finite_number(words[static_cast<std::size_t>(k)], file, line);
    if (!value) return std::unexpected(value.error());
    result[k] = *value;
  }
  return result;
}

Expected<MeshPoints> read_obj(std::string_view bytes, std::string_view file) {
  MeshPoints mesh{.format = "OBJ"};
  for (LineReader lines(bytes); lines.next();) {
    const auto line = trimmed(lines.line());
    if (!line.starts_with("v ") && !line.starts_with("v\t")) continue;
    const auto words = words_of(line);
    if (words.size() < 4) return data_error(file, lines.number(), "a vertex has three coordinates");
    const auto point = point_of(std::span(words).subspan(1), file, lines.number());
    if (!point) return std::unexpected(point.error());
    mesh.points.push_back(*point);
  }
  if (mesh.points.empty()) return data_error(file, 0, "there are no vertices \"v x y z\"");
  return mesh;
}

Expected<MeshPoints> read_xyz(std::string_view bytes, std::string_view file) {
  MeshPoints mesh{.format = "XYZ"};
  std::size_t columns = 0;
  for (LineReader lines(bytes); lines.next();) {
    const auto words = words_of(lines.line().substr(0, lines.line().find('#')), ",;");
    if (words.empty()) continue;
    if (columns == 0) columns = words.size();
    if ((columns != 3 && columns != 6) || words.size() != columns) {
      return data_error(
          file, lines.number(),
          fmt::format("there are {} columns{}", words.size(),
                      words.size() != columns ? fmt::format(", {} before", columns) : ""),
          "write x y z, or x y z and the normal, on every line");
    }
    const auto point = point_of(words, file, lines.number());
    if (!point) return std::unexpected(point.error());
    mesh.points.push_back(*point);
    if (columns == 3) continue;
    const auto normal = point_of(std::span(words).subspan(3), file, lines.number());
    if (!normal) return std::unexpected(normal.error());
    mesh.normals.push_back(*normal);
  }
  if (mesh.points.empty()) return data_error(file, 0, "there are no points");
  return mesh;
}

Expected<MeshPoints> read_vtk(std::string_view bytes, std::string_view file) {
  auto read = is_vtk_legacy(bytes) ? read_vtk_legacy(bytes, file) : read_vtk_xml(bytes, file);
  if (!read) return std::unexpected(std::move(read.error()));
  return MeshPoints{.format = "VTK", .points = std::move(read->points), .normals = {}};
}

/// Whether the first line with a word begins as those of OBJ do; lines of numbers do not.
bool begins_as_obj(std::string_view bytes) {
  static constexpr std::string_view words[] = {"v", "vn", "vt", "o", "g", "s", "mtllib", "usemtl"};
  while (!bytes.empty()) {
    const std::string_view line = bytes.substr(0, bytes.find_first_of("\r\n"));
    bytes.remove_prefix(std::min(line.size() + 1, bytes.size()));
    const std::string_view word = line.substr(0, line.find_first_of(" \t"));
    if (!word.empty() && word.front() != '#')
      return word.size() < line.size() && std::ranges::find(words, word) != std::end(words);
  }
  return false;
}

/// Whether it is STL: ASCII by its first word, binary by its size, 84 bytes and 50 per triangle.
bool is_stl(std::string_view bytes) {
  if (bytes.starts_with("solid") && bytes.find("facet") != bytes.npos) return true;
  if (bytes.size() < 84) return false;
  std::uint32_t triangles = 0;
  for (int k = 3; k >= 0; --k)
    triangles =
        triangles << 8 | static_cast<unsigned char>(bytes[80 + static_cast<std::size_t>(k)]);
  return bytes.size() == 84 + 50 * std::size_t{triangles};
}

}  // namespace

Expected<MeshPoints> read_mesh_points(std::string_view bytes, std::string_view file) {
  if (is_vtk_legacy(bytes) || is_vtk_xml(bytes)) return read_vtk(bytes, file);
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return read_ply(bytes, file);
  const std::string name = lower_case(file);
  if (name.ends_with(".obj")) return read_obj(bytes, file);
  if (name.ends_with(".stl")) return read_stl(bytes, file);
  if (name.ends_with(".ply")) return read_ply(bytes, file);
  if (begins_as_obj(bytes)) return read_obj(bytes, file);
  if (is_stl(bytes)) return read_stl(bytes, file);
  return read_xyz(bytes, file);
}

MeshPoints joined(MeshPoints mesh) {
  const auto less = [&](std::size_t a, std::size_t b) {
    return std::ranges::lexicographical_compare(mesh.points[a], mesh.points[b]);
  };
  std::set<std::size_t, decltype(less)> known(less);
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < mesh.points.size(); ++k) {
    if (known.insert(k).second) kept.push_back(k);
  }
  MeshPoints result{.format = mesh.format};
  for (const auto k : kept) {
    result.points.push_back(mesh.points[k]);
    if (!mesh.normals.empty()) result.normals.push_back(mesh.normals[k]);
  }
  return result;
}

}  // namespace knead::fields
