#include <cmath>

#include "distance_jet.hpp"
#include "shape_kernel.hpp"
#include "spline/bezier_patch.hpp"

namespace knead::detail {
namespace {

class SplineKernel final : public ShapeKernel {
 public:
  SplineKernel(std::vector<std::unique_ptr<Patch>> patches, double extent)
      : search_(std::move(patches), extent) {
    const Range3& b = search_.box();
    for (int k = 0; k < 3; ++k) {
      box.lower[k] = b.axis[static_cast<std::size_t>(k)].lower;
      box.upper[k] = b.axis[static_cast<std::size_t>(k)].upper;
    }
    size = box.diagonal();
  }

  Nearest nearest(const Point& x) const override {
    const FootResult found = search_.nearest(x);
    const Patch& patch = search_.patch(found.best.patch);
    const DistanceJet d = distance_jet(x, found.best, patch, side(x, found), search_.size());
    return {d.distance, found.best.jet[0], d.normal, d.hessian, found.certified};
  }

 private:
  /// 1 where x is outside. On a crease the sum of the adjacent normals decides (J. Baerentzen and
  /// H. Aanaes, Signed distance computation using the angle weighted pseudonormal; on an edge both
  /// angles are equal).
  [[nodiscard]] double side(const Point& x, const FootResult& found) const {
    const bool pressed = found.best.pressed[0] || found.best.pressed[1];
    if (pressed && found.neighbours.empty()) return 1;
    Point n = foot_normal(found.best, search_.patch(found.best.patch));
    for (const Foot& f : found.neighbours) n += foot_normal(f, search_.patch(f.patch));
    return n.dot(x - found.best.jet[0]) < 0 ? -1 : 1;
  }

  FootSearch search_;
};

}  // namespace

Expected<Kernel> spline_kernel(const Surface& surface, const Point& scale) {
  auto patches = bezier_patches(surface, scale);
  if (!patches) return std::unexpected(patches.error());
  const Points& net = surface.control_points();
  const Eigen::Vector3d extent =
      (net.colwise().maxCoeff() - net.colwise().minCoeff()).transpose().cwiseProduct(scale);
  if (!(extent.norm() > 0))
    return input_error("all control points are the same", "surface", "use a surface");
  return std::make_unique<SplineKernel>(std::move(*patches), 0.5 * extent.norm());
}

}  // namespace knead::detail
