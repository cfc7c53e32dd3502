#include "surface_mesh.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "exchange/format_list.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::detail {
Expected<NamedMesh> mesh_of(const NamedSurface& item, const std::array<GridLines, 2>& lines) {
  auto mesh = brep::grid_mesh(item.surface, lines);
  if (!mesh) return std::unexpected(mesh.error().within(item.called()));
  return NamedMesh{item.name, std::move(mesh->points), std::move(mesh->normals),
                   std::move(mesh->triangles)};
}

Expected<void> fits_single_precision(const NamedMesh& mesh, std::string_view format) {
  if (mesh.points.size() == 0 ||
      mesh.points.cwiseAbs().maxCoeff() <= std::numeric_limits<float>::max())
    return {};
  return numerical_error(fmt::format("a coordinate is too large for {}", format), mesh.name,
                         "write OBJ or PLY");
}

Expected<std::vector<NamedMesh>> meshes_of(std::span<const NamedSurface> surfaces,
                                           const SaveOptions& options) {
  constexpr int most_detail = 2000;
  if (surfaces.empty()) return nothing_to_write();
  if (options.detail < 1 || options.detail > most_detail) {
    return input_error(fmt::format("{} is not a detail", options.detail), "detail",
                       fmt::format("use a number from 1 to {}", most_detail));
  }
  std::vector<NamedMesh> result;
  for (const NamedSurface& item : surfaces) {
    auto mesh = mesh_of(item, {grid_lines(item.surface.knots(0), options.detail),
                               grid_lines(item.surface.knots(1), options.detail)});
    if (!mesh) return std::unexpected(mesh.error());
    result.push_back(std::move(*mesh));
  }
  return result;
}

}  // namespace knead::detail
