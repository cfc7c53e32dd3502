// How elementary and swept surfaces bend.
#include <Eigen/Geometry>
#include <cmath>

#include "face_surface.hpp"
#include "knead/spline/closest_point.hpp"

namespace knead::brep {

Expected<SurfaceCurvature> FaceSurface::curvature(const Eigen::Vector2d& uv) const {
  // Of a patch in directions that are closed; in others a length, or a parameter.
  constexpr double half_angle = 0.125;
  const double half_length = reach_ > 0 ? half_angle * reach_ : 1;
  const auto domain = whole();
  std::array<Interval, 2> range;
  for (int d = 0; d < 2; ++d) {
    const auto k = static_cast<std::size_t>(d);
    const bool curved = periods_[k] > 0 || kind_ == Kind::sphere || kind_ == Kind::torus;
    const double half = curved ? half_angle : half_length;
    range[k] = domain[k].value_or(Interval{uv[d] - half, uv[d] + half});
    if (d == 0 || domain[k]) continue;
    // A pole on one side makes both sides shorter, so that the point stays in the middle.
    double room = half;
    if (poles_[0]) room = std::min(room, uv[d] - *poles_[0]);
    if (poles_[1]) room = std::min(room, *poles_[1] - uv[d]);
    if (!(room > 0)) return numerical_error("there is no tangent plane at a pole", "");
    range[k] = {uv[d] - room, uv[d] + room};
  }
  const auto part = patch(range[0], range[1]);
  if (!part) return std::unexpected(part.error());
  // Arcs about the point have it in their middle; on swept curves parameters may run at another
  // speed.
  std::array<double, 2> place = {uv[0], uv[1]};
  if (profile_) {
    const auto search = ClosestPointSearch<2>::create(*part);
    if (!search) return std::unexpected(search.error());
    place = search->nearest(at(uv)).parameters;
  }
  return knead::curvature(*part, place);
}

/// Surfaces of revolution bend by the parallel as by Meusnier's theorem, −(n · e)/ρ with e the
/// direction away from the axis at the distance ρ, and along the meridian as the circle that turns
/// or not at all (do Carmo, Differential Geometry of Curves and Surfaces, 3-2 and 3-3).
Expected<Eigen::Matrix3d> FaceSurface::shape_operator(const Eigen::Vector2d& uv) const {
  if (kind_ == Kind::plane) return Eigen::Matrix3d(Eigen::Matrix3d::Zero());
  if (profile_) {
    const auto bends = curvature(uv);
    if (!bends) return std::unexpected(bends.error());
    return knead::shape_operator(*bends);
  }
  const Point p = at(uv), n = normal(uv);
  if (kind_ == Kind::sphere) {
    const double bending = -n.dot((p - frame_.origin).normalized()) / std::abs(radius_);
    return Eigen::Matrix3d(bending * (Eigen::Matrix3d::Identity() - n * n.transpose()));
  }
  Point away = p - frame_.origin;
  away -= away.dot(frame_.z) * frame_.z;
  const double distance = away.norm();
  if (!(distance > 1e-9 * reach_))
    return numerical_error("there is no tangent plane at an apex", "");
  const Point e = away / distance, along = frame_.z.cross(e);
  Eigen::Matrix3d result = -n.dot(e) / distance * along * along.transpose();
  if (kind_ == Kind::torus && minor_ != 0) {
    const Point across = n.cross(along);
    // The circle through the point is the nearer one of the two in this half plane.
    const Point outwards = p - (frame_.origin + (inner_ ? -1 : 1) * radius_ * e),
                other = p - (frame_.origin - radius_ * e);
    const double minor = std::abs(minor_);
    const bool near = std::abs(outwards.norm() - minor) <= std::abs(other.norm() - minor);
    result -= n.dot(near ? outwards : other) / (minor * minor) * across * across.transpose();
  }
  return result;
}

}  // namespace knead::brep
