// How elementary and swept surfaces bend.
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

}  // namespace knead::brep
