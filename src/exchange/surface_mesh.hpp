#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "knead/exchange/format.hpp"

namespace knead::detail {

/// Triangles of one surface.
struct SurfaceMesh {
  std::string name;
  Points points, normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The triangles of all surfaces, as described at `save_surfaces`, and their number.
struct SurfaceMeshes {
  std::vector<SurfaceMesh> meshes;
  std::size_t triangles = 0;
};
[[nodiscard]] Expected<SurfaceMeshes> meshes_of(std::span<const NamedSurface> surfaces, const SaveOptions& options);

/// (b − a) × (c − a), of a triangle's corners.
[[nodiscard]] Point facet(const Points& points, const std::array<std::uint32_t, 3>& triangle);

/// Whether all coordinates can be written in single precision; if not, an error that names the surface and the format.
[[nodiscard]] Expected<void> fits_single_precision(const SurfaceMesh& mesh, std::string_view format);

/// ", lengths in mm", or nothing if the unit is unknown.
[[nodiscard]] inline std::string lengths_in(const std::string& unit) {
  return unit.empty() ? "" : ", lengths in " + unit;
}

/// Appends a number as in binary formats, little endian.
template <class T>
void append(std::string& to, T value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  to.append(bytes.data(), bytes.size());
}

template <class T, class Row>
void append_point(std::string& to, const Row& point) {
  for (Eigen::Index d = 0; d < 3; ++d) append(to, static_cast<T>(point[d]));
}

}  // namespace knead::detail
