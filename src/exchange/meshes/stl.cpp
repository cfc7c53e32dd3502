#include <Eigen/Geometry>
#include <cstring>

#include "exchange/format_list.hpp"
#include "surface_mesh.hpp"

namespace knead::detail {
namespace {

/// Whether two corners of a triangle are one in single precision: it would have no area and no
/// normal. What shares them collapses along the same side, so that a closed mesh stays closed.
bool collapses(const Points& points, const std::array<std::uint32_t, 3>& triangle) {
  const auto corner = [&](std::size_t k) -> Eigen::Vector3f {
    return points.row(triangle[k]).cast<float>();
  };
  return corner(0) == corner(1) || corner(1) == corner(2) || corner(2) == corner(0);
}

// Binary STL: 80 bytes of text, the number of triangles, and of each 50 bytes: the normal, three
// corners and two bytes of attributes. Triangles share no points, so the number is known only once
// those that collapse are left out; it is put in at the end. Text that begins with "solid" would be
// taken for the other form of STL.
Expected<std::string> save_stl(std::span<const NamedMesh> all, const SaveOptions& options) {
  constexpr std::size_t header = 80;
  std::string text = "Knead" + lengths_in(options.unit);
  text.resize(header, ' ');
  std::uint32_t count = 0;
  append(text, count);
  for (const NamedMesh& mesh : all) {
    if (auto fits = fits_single_precision(mesh, "STL"); !fits) return std::unexpected(fits.error());
    for (const auto& t : mesh.triangles) {
      if (collapses(mesh.points, t)) continue;
      ++count;
      append_point<float>(text, facet(mesh.points, t).normalized());
      for (const std::uint32_t corner : t) append_point<float>(text, mesh.points.row(corner));
      append(text, std::uint16_t{0});
    }
  }
  std::memcpy(text.data() + header, &count, sizeof count);
  return text;
}

constexpr std::string_view stl_endings[] = {".stl"};

}  // namespace

Format stl_format() {
  return {.id = "stl",
          .name = "STL",
          .endings = stl_endings,
          .media_type = "model/stl",
          .content = FormatContent::triangles,
          .holds = "triangles with the normal of each, binary, single precision",
          .save_meshes = save_stl};
}

}  // namespace knead::detail
