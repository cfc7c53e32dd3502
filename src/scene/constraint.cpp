#include "constraint.hpp"

namespace knead {

std::vector<SurfaceEdge> edges_of(EdgeChoice which) {
  switch (which) {
    case EdgeChoice::u0:
      return {SurfaceEdge::u0};
    case EdgeChoice::u1:
      return {SurfaceEdge::u1};
    case EdgeChoice::v0:
      return {SurfaceEdge::v0};
    case EdgeChoice::v1:
      return {SurfaceEdge::v1};
    case EdgeChoice::all:
      break;
  }
  return {SurfaceEdge::u0, SurfaceEdge::u1, SurfaceEdge::v0, SurfaceEdge::v1};
}

Expected<MirrorPlane> plane_of(const MirrorSymmetry& symmetry, const Surface& surface) {
  if (symmetry.plane) return *symmetry.plane;
  return mirror_plane(surface, symmetry.direction);
}

std::array<int, 2> mirror_image(const MirrorSymmetry& symmetry, const std::array<int, 2>& net,
                                const std::array<int, 2>& point) {
  std::array<int, 2> image = point;
  const auto d = static_cast<std::size_t>(symmetry.direction);
  image[d] = net[d] - 1 - point[d];
  return image;
}

}  // namespace knead
