#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "brep/tessellation/grid_mesh.hpp"
#include "knead/exchange/format.hpp"
#include "spline/grid_lines.hpp"

namespace knead::detail {

/// The triangles of all surfaces, as described at `save_surfaces`.
[[nodiscard]] Expected<std::vector<NamedMesh>> meshes_of(std::span<const NamedSurface> surfaces,
                                                         const SaveOptions& options);
/// Those of one, between these lines.
[[nodiscard]] Expected<NamedMesh> mesh_of(const NamedSurface& item,
                                          const std::array<GridLines, 2>& lines);

using brep::facet;

[[nodiscard]] inline std::size_t number_of_triangles(std::span<const NamedMesh> meshes) {
  std::size_t count = 0;
  for (const NamedMesh& mesh : meshes) count += mesh.triangles.size();
  return count;
}

/// Whether all coordinates can be written in single precision; if not, an error that names the
/// surface and the format.
[[nodiscard]] Expected<void> fits_single_precision(const NamedMesh& mesh, std::string_view format);

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
