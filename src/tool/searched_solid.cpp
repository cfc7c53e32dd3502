#include "searched_solid.hpp"

#include <cmath>

#include "distance_jet.hpp"

namespace knead::detail {

SearchedSolid::SearchedSolid(Patches patches, Inside inside, std::array<bool, 3> fold, bool round,
                             const BoundingBox& extent, double feature)
    : inside_(std::move(inside)), fold_(fold), round_(round) {
  box = extent;
  size = feature;
  for (auto& patch : patches) orient(*patch);
  search_ = std::make_unique<FootSearch>(std::move(patches),
                                         0.5 * (extent.upper - extent.lower).maxCoeff());
}

Nearest SearchedSolid::nearest(const Point& x) const {
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  // columns: the axes of the folded frame
  Point y = x;
  const double rho = std::hypot(x.x(), x.y());
  if (round_) {
    const Point e = rho > 0 ? Point(x.x() / rho, x.y() / rho, 0) : Point::UnitX();
    frame.col(0) = e;
    frame.col(1) = Point(-e.y(), e.x(), 0);
    y = Point(rho, 0, x.z());
  }
  for (int k = 0; k < 3; ++k) {
    if (!fold_[static_cast<std::size_t>(k)] || !std::signbit(y[k])) continue;
    frame.col(k) *= -1;
    y[k] = -y[k];
  }
  const FootResult found = search_->nearest(y);
  const DistanceJet d = distance_jet(y, found.best, search_->patch(found.best.patch),
                                     inside_(y) ? -1 : 1, search_->size());
  Nearest r;
  r.converged = found.certified;
  r.distance = d.distance;
  r.point = frame * found.best.jet[0];
  if (round_ && rho == 0 && std::abs(d.normal.x()) > 1e-12)
    return r;  // a circle of points is nearest
  r.normal = frame * d.normal;
  r.hessian = frame * d.hessian * frame.transpose();
  return r;
}

void SearchedSolid::orient(Patch& patch) const {
  const PatchJet j = patch.jet(0.5, patch.domain.centre()[1]);
  const Point n = j[1].cross(j[2]).normalized();
  if (inside_(j[0] + 1e-7 * (box.upper - box.lower).minCoeff() * n)) patch.orientation = -1;
}

}  // namespace knead::detail
