// Which sheet of a cone or a torus a face lies on.
#include <cmath>
#include <numbers>

#include "face_surface.hpp"

namespace knead::brep {

/// Replaces the half angle of a cone by its tangent, in the unit that brings the cone closest to
/// the points on it.
bool FaceSurface::find_half_angle(std::span<const Point> on_it,
                                  std::span<const double> angle_units) {
  const double angle = minor_;
  double best = std::numeric_limits<double>::infinity();
  for (const double unit : angle_units) {
    if (!(std::abs(angle * unit) < std::numbers::pi / 2)) continue;
    const double tangent = std::tan(angle * unit);
    double off = 0;
    for (const Point& p : on_it) {
      const Point d = p - frame_.origin;
      const double z = d.dot(frame_.z);
      off = std::max(off, std::abs((d - z * frame_.z).norm() - std::abs(radius_ + z * tangent)));
    }
    if (off >= best) continue;
    best = off;
    minor_ = tangent;
  }
  return std::isfinite(best);
}

/// Which sheet is meant of a cone, whose nappes meet in its apex, and of a torus that crosses its
/// axis: the one closer to the points on it. Only DEGENERATE_TOROIDAL_SURFACE says so itself, which
/// few writers use.
void FaceSurface::find_sheet(std::span<const Point> on_it) {
  if (kind_ != Kind::cone && !(kind_ == Kind::torus && minor_ > radius_)) return;
  std::array<double, 2> off = {0, 0};
  for (const Point& p : on_it) {
    const Point d = p - frame_.origin;
    const double z = d.dot(frame_.z), rho = (d - z * frame_.z).norm();
    for (const std::size_t inner : {0, 1}) {
      const double side = inner == 1 ? -1 : 1;
      const double away = kind_ == Kind::cone ? rho - side * (radius_ + z * minor_)
                                              : std::hypot(rho - side * radius_, z) - minor_;
      off[inner] = std::max(off[inner], std::abs(away));
    }
  }
  if (off[0] != off[1]) inner_ = off[1] < off[0];
}

std::shared_ptr<const ChartedSurface> FaceSurface::other_sense() const {
  if (!inner_ || mirrored_) return nullptr;
  auto other = std::make_shared<FaceSurface>(*this);
  other->frame_.y = -frame_.y;
  other->mirrored_ = true;
  return other;
}

}  // namespace knead::brep
