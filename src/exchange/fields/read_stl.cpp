// STL: triangles without shared points, as text or as 50 bytes each after a header of 84.
#include <fmt/format.h>

#include "line_reader.hpp"
#include "mesh_points.hpp"
#include "raw_numbers.hpp"

namespace knead::fields {
namespace {

constexpr std::size_t header = 84, facet = 50;

/// Every three points are a triangle.
void add_triangles(MeshPoints& mesh) {
  for (std::uint32_t k = 0; k + 2 < mesh.points.size(); k += 3)
    mesh.triangles.push_back({k, k + 1, k + 2});
}

Expected<MeshPoints> read_text(std::string_view bytes, std::string_view file) {
  MeshPoints mesh{.format = "STL"};
  for (LineReader lines(bytes); lines.next();) {
    const auto words = words_of(lines.line());
    if (words.empty() || lower_case(words[0]) != "vertex") continue;
    if (words.size() != 4)
      return data_error(file, lines.number(), "a vertex has three coordinates");
    Point point;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto value = finite_number(words[k + 1], file, lines.number());
      if (!value) return std::unexpected(value.error());
      point[static_cast<Eigen::Index>(k)] = *value;
    }
    mesh.points.push_back(point);
  }
  if (mesh.points.empty() || mesh.points.size() % 3 != 0)
    return data_error(file, 0, fmt::format("{} vertices make no triangles", mesh.points.size()));
  add_triangles(mesh);
  return mesh;
}

Expected<MeshPoints> read_binary(std::string_view bytes, std::string_view file) {
  const RawNumber count_type{RawNumber::Kind::natural, 4}, coordinate{RawNumber::Kind::real, 4};
  if (bytes.size() < header)
    return data_error(file, 0,
                      fmt::format("it has {} bytes, fewer than the header of STL", bytes.size()));
  const auto count =
      static_cast<std::size_t>(read_raw(bytes.data() + header - 4, count_type, false));
  if (count > (bytes.size() - header) / facet)
    return data_error(file, 0,
                      fmt::format("{} triangles are announced and {} there", count,
                                  (bytes.size() - header) / facet));
  if (count == 0) return data_error(file, 0, "there are no triangles");
  MeshPoints mesh{.format = "STL"};
  mesh.points.reserve(3 * count);
  for (std::size_t k = 0; k < count; ++k) {
    // The normal comes first.
    const char* const corners = bytes.data() + header + facet * k + 12;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Point point;
      for (std::size_t d = 0; d < 3; ++d)
        point[static_cast<Eigen::Index>(d)] =
            read_raw(corners + 12 * corner + 4 * d, coordinate, false);
      if (!point.allFinite())
        return data_error(file, 0, fmt::format("a coordinate of triangle {} is not finite", k + 1));
      mesh.points.push_back(point);
    }
  }
  add_triangles(mesh);
  return mesh;
}

}  // namespace

// Binary files may begin with "solid" too: then their size tells.
Expected<MeshPoints> read_stl(std::string_view bytes, std::string_view file) {
  if (trimmed(bytes.substr(0, 80)).starts_with("solid")) {
    const bool sized =
        bytes.size() >= header &&
        static_cast<double>(bytes.size() - header) ==
            50 * read_raw(bytes.data() + header - 4, {RawNumber::Kind::natural, 4}, false);
    if (!sized) return read_text(bytes, file);
  }
  return read_binary(bytes, file);
}

}  // namespace knead::fields
