#include <fmt/format.h>

#include "exchange/format_list.hpp"
#include "surface_mesh.hpp"

namespace knead::detail {
namespace {

Expected<std::string> save_ply(std::span<const NamedMesh> all, const SaveOptions& options) {
  Eigen::Index vertices = 0;
  for (const NamedMesh& mesh : all) vertices += mesh.points.rows();
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment Knead{}\nelement vertex {}\nproperty double "
      "x\nproperty double y\n"
      "property double z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face "
      "{}\n"
      "property list uchar uint vertex_indices\nend_header\n",
      lengths_in(options.unit), vertices, number_of_triangles(all));
  for (const NamedMesh& mesh : all) {
    for (Eigen::Index k = 0; k < mesh.points.rows(); ++k) {
      append_point<double>(text, mesh.points.row(k));
      append_point<float>(text, mesh.normals.row(k));
    }
  }
  std::uint32_t first = 0;
  for (const NamedMesh& mesh : all) {
    for (const auto& t : mesh.triangles) {
      text.push_back(3);
      for (const std::uint32_t corner : t) append(text, first + corner);
    }
    first += static_cast<std::uint32_t>(mesh.points.rows());
  }
  return text;
}

constexpr std::string_view ply_endings[] = {".ply"};

}  // namespace

Format ply_format() {
  return {.id = "ply",
          .name = "PLY",
          .endings = ply_endings,
          .media_type = "application/octet-stream",
          .content = FormatContent::triangles,
          .holds = "triangles with normals at the points, binary, points in double precision",
          .save_meshes = save_ply};
}

}  // namespace knead::detail
