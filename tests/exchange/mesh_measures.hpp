#pragma once

#include <Eigen/Geometry>
#include <span>

#include "brep/tessellation/context_faces.hpp"

namespace knead::testing {

inline double area_of(const FaceMesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    area += (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]).norm() / 2;
  }
  return area;
}

/// Of a closed mesh, by the divergence theorem.
inline double volume_of(std::span<const FaceMesh> faces) {
  double volume = 0;
  const Point origin =
      faces.empty() || faces.front().points.empty() ? Point::Zero() : faces.front().points.front();
  for (const FaceMesh& mesh : faces) {
    for (const auto& [a, b, c] : mesh.triangles) {
      volume +=
          (mesh.points[a] - origin).dot((mesh.points[b] - origin).cross(mesh.points[c] - origin)) /
          6;
    }
  }
  return volume;
}

}  // namespace knead::testing
