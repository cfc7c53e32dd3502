#include "grid_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "knead/spline/evaluate.hpp"

namespace knead::brep {
namespace {

// |cross product| over the longest side squared: less is degenerate.
constexpr double sliver = 1e-12;
constexpr double vanishing = 1e-9;  // |S_u × S_v| over |S_u|² + |S_v|²

bool is_triangle(const Points& points, const std::array<std::uint32_t, 3>& t) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, (points.row(t[k]) - points.row(t[(k + 1) % 3])).squaredNorm());
  }
  return facet(points, t).norm() > sliver * longest;
}

}  // namespace

Point facet(const Points& points, const std::array<std::uint32_t, 3>& t) {
  const Point a = points.row(t[0]), b = points.row(t[1]), c = points.row(t[2]);
  return (b - a).cross(c - a);
}

Expected<GridMesh> grid_mesh(const Surface& surface, const std::array<GridLines, 2>& lines) {
  const auto& [u, v] = lines;
  const std::array<std::span<const double>, 2> grid = {u.parameters, v.parameters};
  auto jet = evaluate_grid<2>(surface, grid, 1);
  if (!jet) return std::unexpected(jet.error());
  GridMesh mesh{jet->points(), Points::Zero(jet->points().rows(), 3), {}};
  const auto rows = static_cast<std::uint32_t>(u.parameters.size()),
             columns = static_cast<std::uint32_t>(v.parameters.size());
  for (std::uint32_t k = 0; k + 1 < rows; ++k) {
    for (std::uint32_t l = 0; l + 1 < columns; ++l) {
      const std::uint32_t a = k * columns + l, b = a + columns;
      for (const std::array<std::uint32_t, 3>& t :
           {std::array{a, b, b + 1}, std::array{a, b + 1, a + 1}}) {
        if (is_triangle(mesh.points, t)) mesh.triangles.push_back(t);
      }
    }
  }
  std::vector<bool> vanishes(static_cast<std::size_t>(mesh.points.rows()));
  for (Eigen::Index k = 0; k < mesh.points.rows(); ++k) {
    const Point a = jet->at({1, 0}).row(k), b = jet->at({0, 1}).row(k), normal = a.cross(b);
    const double length = normal.norm();
    if (length > vanishing * (a.squaredNorm() + b.squaredNorm())) {
      mesh.normals.row(k) = normal.transpose() / length;
    } else {
      vanishes[static_cast<std::size_t>(k)] = true;
    }
  }
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t corner : t) {
      if (vanishes[corner])
        mesh.normals.row(corner) += facet(mesh.points, t).normalized().transpose();
    }
  }
  for (Eigen::Index k = 0; k < mesh.points.rows(); ++k) {
    if (const double length = mesh.normals.row(k).norm(); length > 0) mesh.normals.row(k) /= length;
  }
  return mesh;
}

}  // namespace knead::brep
