#include "surface_foot.hpp"

#include <cmath>

#include "step_surfaces.hpp"

namespace knead::step {
namespace {

constexpr double single_point = 1e-6;  // of the net's diagonal: an edge of the domain no longer than this is a pole
constexpr double at_pole = 1e-5;       // fractions

}  // namespace

Expected<SurfaceFoot> SurfaceFoot::create(const Surface& surface) {
  auto search = ClosestPointSearch<2>::create(surface);
  if (!search) return std::unexpected(std::move(search.error()));
  SurfaceFoot result(std::move(*search));
  const auto closed = closed_directions(surface);
  const double size = net_diagonal(surface.control_points());
  for (int d = 0; d < 2; ++d) {
    result.domain_[static_cast<std::size_t>(d)] = surface.knots(d).domain();
    if (closed[static_cast<std::size_t>(d)]) result.space_.periods[static_cast<std::size_t>(d)] = 1;
    for (int end = 0; end < 2; ++end) {
      const auto side = boundary_curve(surface, d, end);
      if (side && net_diagonal(side->control_points()) <= single_point * size) {
        result.space_.poles[static_cast<std::size_t>(d)][static_cast<std::size_t>(end)] = end;
      }
    }
  }
  return result;
}

SurfaceFoot::Result SurfaceFoot::result_of(const ClosestPoint<2>& closest) const {
  Result result{{}, closest.distance};
  for (int d = 0; d < 2; ++d) {
    const Interval& domain = domain_[static_cast<std::size_t>(d)];
    result.foot.parameters[d] = (closest.parameters[static_cast<std::size_t>(d)] - domain.lower) / domain.length();
  }
  for (int d = 0; d < 2; ++d) {
    for (const auto& end : space_.poles[static_cast<std::size_t>(d)]) {
      if (end && std::abs(result.foot.parameters[d] - *end) <= at_pole) {
        result.foot.free[static_cast<std::size_t>(1 - d)] = true;
      }
    }
  }
  return result;
}

SurfaceFoot::Result SurfaceFoot::nearest(const Point& p, const std::optional<Eigen::Vector2d>& hint,
                                         double tolerance) const {
  if (hint) {
    std::array<double, 2> start;
    for (std::size_t d = 0; d < 2; ++d) {
      start[d] = domain_[d].lower + (*hint)[static_cast<Eigen::Index>(d)] * domain_[d].length();
    }
    const Result found = result_of(search_.nearest_from(p, start, {space_.periods[0] > 0, space_.periods[1] > 0}));
    if (found.distance <= tolerance) return found;
  }
  return result_of(search_.nearest(p));
}

}  // namespace knead::step
