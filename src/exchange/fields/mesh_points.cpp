#include "mesh_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

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

Expected<void> read_obj_face(std::string_view line, std::string_view file, int number,
                             MeshPoints& mesh) {
  std::vector<double> corners;
  const auto words = words_of(line);
  for (const auto word : std::span(words).subspan(1)) {
    const auto corner = finite_number(word.substr(0, word.find('/')), file, number);
    if (!corner) return std::unexpected(corner.error());
    corners.push_back(*corner);
  }
  return add_face(corners, 1, file, number, mesh);
}

Expected<MeshPoints> read_obj(std::string_view bytes, std::string_view file) {
  MeshPoints mesh{.format = "OBJ"};
  for (LineReader lines(bytes); lines.next();) {
    const auto line = trimmed(lines.line());
    if (line.starts_with("f ") || line.starts_with("f\t")) {
      if (auto face = read_obj_face(line, file, lines.number(), mesh); !face)
        return std::unexpected(face.error());
    }
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

Expected<void> add_face(const std::vector<double>& numbers, double first, std::string_view file,
                        int line, MeshPoints& mesh) {
  std::vector<std::uint32_t> corners;
  const auto count = static_cast<double>(mesh.points.size());
  for (const double number : numbers) {
    const double k = first == 1 && number < 0 ? count + number : number - first;
    if (!(k >= 0 && k < count && k == std::floor(k)))
      return data_error(file, line,
                        fmt::format("a face has the point {}, of {}", number, mesh.points.size()));
    corners.push_back(static_cast<std::uint32_t>(k));
  }
  for (std::size_t k = 2; k < corners.size(); ++k)
    mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
  return {};
}

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
    const Point &p = mesh.points[a], &q = mesh.points[b];
    for (Eigen::Index c = 0; c < 3; ++c) {
      if (p[c] != q[c]) return p[c] < q[c];
    }
    return a < b;
  };
  std::vector<std::size_t> order(mesh.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, less);
  std::vector<std::size_t> first(mesh.points.size());  // the first point with the same coordinates
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && mesh.points[order[k]] == mesh.points[order[k - 1]];
    first[order[k]] = same ? first[order[k - 1]] : order[k];
  }
  MeshPoints result{.format = mesh.format};
  std::vector<std::uint32_t> number(mesh.points.size());
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k] != k) continue;
    number[k] = static_cast<std::uint32_t>(result.points.size());
    result.points.push_back(mesh.points[k]);
    if (!mesh.normals.empty()) result.normals.push_back(mesh.normals[k]);
  }
  for (const auto& corners : mesh.triangles) {
    const std::uint32_t a = number[first[corners[0]]], b = number[first[corners[1]]],
                        c = number[first[corners[2]]];
    if (a != b && b != c && c != a) result.triangles.push_back({a, b, c});
  }
  return result;
}

}  // namespace knead::fields
