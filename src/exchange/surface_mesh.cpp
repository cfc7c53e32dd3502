#include "surface_mesh.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "knead/spline/evaluate.hpp"

namespace knead::detail {
namespace {

constexpr double sliver = 1e-12;     // |cross product| over the longest side squared: less is degenerate
constexpr double degenerate = 1e-9;  // |S_u × S_v| over |S_u|² + |S_v|²

bool is_triangle(const Points& points, const std::array<std::uint32_t, 3>& t) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, (points.row(t[k]) - points.row(t[(k + 1) % 3])).squaredNorm());
  }
  return facet(points, t).norm() > sliver * longest;
}

}  // namespace

Expected<NamedMesh> mesh_of(const NamedSurface& item, const std::array<GridLines, 2>& lines) {
  const auto& [u, v] = lines;
  const std::array<std::span<const double>, 2> grid = {u.parameters, v.parameters};
  auto jet = evaluate_grid<2>(item.surface, grid, 1);
  if (!jet) return std::unexpected(jet.error().within(item.name));
  NamedMesh mesh{item.name, jet->points(), Points::Zero(jet->points().rows(), 3), {}};
  const auto rows = static_cast<std::uint32_t>(u.parameters.size()),
             columns = static_cast<std::uint32_t>(v.parameters.size());
  for (std::uint32_t k = 0; k + 1 < rows; ++k) {
    for (std::uint32_t l = 0; l + 1 < columns; ++l) {
      const std::uint32_t a = k * columns + l, b = a + columns;
      for (const std::array<std::uint32_t, 3>& t : {std::array{a, b, b + 1}, std::array{a, b + 1, a + 1}}) {
        if (is_triangle(mesh.points, t)) mesh.triangles.push_back(t);
      }
    }
  }
  std::vector<bool> vanishes(static_cast<std::size_t>(mesh.points.rows()));
  for (Eigen::Index k = 0; k < mesh.points.rows(); ++k) {
    const Point a = jet->at({1, 0}).row(k), b = jet->at({0, 1}).row(k), normal = a.cross(b);
    const double length = normal.norm();
    if (length > degenerate * (a.squaredNorm() + b.squaredNorm())) {
      mesh.normals.row(k) = normal.transpose() / length;
    } else {
      vanishes[static_cast<std::size_t>(k)] = true;
    }
  }
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t corner : t) {
      if (vanishes[corner]) mesh.normals.row(corner) += facet(mesh.points, t).normalized().transpose();
    }
  }
  for (Eigen::Index k = 0; k < mesh.points.rows(); ++k) {
    if (const double length = mesh.normals.row(k).norm(); length > 0) mesh.normals.row(k) /= length;
  }
  return mesh;
}

Point facet(const Points& points, const std::array<std::uint32_t, 3>& t) {
  const Point a = points.row(t[0]), b = points.row(t[1]), c = points.row(t[2]);
  return (b - a).cross(c - a);
}

Expected<void> fits_single_precision(const NamedMesh& mesh, std::string_view format) {
  if (mesh.points.size() == 0 || mesh.points.cwiseAbs().maxCoeff() <= std::numeric_limits<float>::max()) return {};
  return numerical_error(fmt::format("a coordinate is too large for {}", format), mesh.name, "write OBJ or PLY");
}

Expected<std::vector<NamedMesh>> meshes_of(std::span<const NamedSurface> surfaces, const SaveOptions& options) {
  constexpr int most_detail = 2000;
  if (surfaces.empty()) return input_error("there is no surface to write", {}, "open a file, or make a surface");
  if (options.detail < 1 || options.detail > most_detail) {
    return input_error(fmt::format("{} is not a detail", options.detail), "detail",
                       fmt::format("use a number from 1 to {}", most_detail));
  }
  std::vector<NamedMesh> result;
  for (const NamedSurface& item : surfaces) {
    auto mesh = mesh_of(
        item, {grid_lines(item.surface.knots(0), options.detail), grid_lines(item.surface.knots(1), options.detail)});
    if (!mesh) return std::unexpected(mesh.error());
    result.push_back(std::move(*mesh));
  }
  return result;
}

}  // namespace knead::detail
