#include <Eigen/Geometry>

#include "format_list.hpp"
#include "surface_mesh.hpp"

namespace knead::detail {
namespace {

Expected<std::string> save_stl(std::span<const NamedMesh> all, const SaveOptions& options) {
  constexpr std::size_t header = 80;
  std::string text = "Knead" + lengths_in(options.unit);
  text.resize(header, ' ');
  append(text, static_cast<std::uint32_t>(number_of_triangles(all)));
  for (const NamedMesh& mesh : all) {
    if (auto fits = fits_single_precision(mesh, "STL"); !fits) return std::unexpected(fits.error());
    for (const auto& t : mesh.triangles) {
      append_point<float>(text, facet(mesh.points, t).normalized());
      for (const std::uint32_t corner : t) append_point<float>(text, mesh.points.row(corner));
      append(text, std::uint16_t{0});
    }
  }
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
