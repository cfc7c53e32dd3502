#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "exchange/format_list.hpp"
#include "surface_mesh.hpp"

namespace knead::detail {
namespace {

Expected<std::string> save_obj(std::span<const NamedMesh> all, const SaveOptions& options) {
  std::string text = "# Knead" + lengths_in(options.unit) + "\n";
  auto out = std::back_inserter(text);
  std::size_t first = 1;
  for (const NamedMesh& mesh : all) {
    std::string name = mesh.name;
    std::ranges::replace_if(
        name, [](char c) { return static_cast<unsigned char>(c) <= ' '; }, '_');
    fmt::format_to(out, "o {}\n", name.empty() ? "surface" : name);
    for (Eigen::Index k = 0; k < mesh.points.rows(); ++k) {
      fmt::format_to(out, "v {} {} {}\n", mesh.points(k, 0), mesh.points(k, 1), mesh.points(k, 2));
    }
    for (Eigen::Index k = 0; k < mesh.normals.rows(); ++k) {
      fmt::format_to(out, "vn {:.6g} {:.6g} {:.6g}\n", mesh.normals(k, 0), mesh.normals(k, 1),
                     mesh.normals(k, 2));
    }
    for (const auto& t : mesh.triangles) {
      fmt::format_to(out, "f {0}//{0} {1}//{1} {2}//{2}\n", first + t[0], first + t[1],
                     first + t[2]);
    }
    first += static_cast<std::size_t>(mesh.points.rows());
  }
  return text;
}

constexpr std::string_view obj_endings[] = {".obj"};

}  // namespace

Format obj_format() {
  return {.id = "obj",
          .name = "OBJ",
          .endings = obj_endings,
          .media_type = "model/obj",
          .content = FormatContent::triangles,
          .holds = "triangles with normals at the points, text, an object per surface",
          .save_meshes = save_obj};
}

}  // namespace knead::detail
