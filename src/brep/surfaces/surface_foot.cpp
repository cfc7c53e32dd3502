#include "surface_foot.hpp"

#include <algorithm>
#include <cmath>

#include "brep/boundary_curve.hpp"
#include "knead/brep/model.hpp"

namespace knead::brep {
namespace {

// Of the net's diagonal: an edge of the domain no longer than this is a pole.
constexpr double single_point = 1e-6;
constexpr double at_pole = 1e-5;       // fractions
constexpr double least_narrow = 1e-8;  // of the net's diagonal

/// How wide the net is where it is widest, in the direction in which that is least.
/// Where the surface is narrow, like a tube or a thin strip bent back on itself, a foot that was
/// found from a hint may lie on the opposite side though it is within the tolerance: a found foot
/// is trusted only within a tenth of this.
double width_of(const Surface& surface) {
  const Eigen::Index n0 = surface.knots(0).count(), n1 = surface.knots(1).count();
  std::array<double, 2> widths = {};
  const Points& points = surface.control_points();
  const auto widest = [&](double& width, Eigen::Index first, Eigen::Index count,
                          Eigen::Index stride) {
    width = std::max(width, net_diagonal(points(Eigen::seqN(first, count, stride), Eigen::all)));
  };
  for (Eigen::Index j = 0; j < n1; ++j) widest(widths[0], j, n0, n1);
  for (Eigen::Index i = 0; i < n0; ++i) widest(widths[1], i * n1, n1, 1);
  return std::min(widths[0], widths[1]);
}

void unwrap(Eigen::Vector2d& at, const Eigen::Vector2d& before, const ParameterSpace& space) {
  for (int d = 0; d < 2; ++d) {
    const double period = space.periods[static_cast<std::size_t>(d)];
    if (period > 0) at[d] += period * std::round((before[d] - at[d]) / period);
  }
}

void settle(Foot& foot, const Foot& next) {
  for (std::size_t d = 0; d < 2; ++d) {
    if (!foot.free[d] || next.free[d]) continue;
    foot.parameters[static_cast<Eigen::Index>(d)] = next.parameters[static_cast<Eigen::Index>(d)];
    foot.free[d] = false;
  }
}

}  // namespace

Expected<SurfaceFoot> SurfaceFoot::create(const Surface& surface) {
  auto search = ClosestPointSearch<2>::create(surface);
  if (!search) return std::unexpected(std::move(search.error()));
  SurfaceFoot result(std::move(*search));
  const auto closed = closed_directions(surface);
  const double size = net_diagonal(surface.control_points());
  result.narrow_ = std::max(0.1 * width_of(surface), least_narrow * size);
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
    result.foot.parameters[d] =
        (closest.parameters[static_cast<std::size_t>(d)] - domain.lower) / domain.length();
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

// A descent from the hint costs a few evaluations, a search of the whole surface many more.
SurfaceFoot::Result SurfaceFoot::nearest(const Point& p, const std::optional<Eigen::Vector2d>& hint,
                                         double tolerance) const {
  if (hint) {
    std::array<double, 2> start;
    for (std::size_t d = 0; d < 2; ++d) {
      start[d] = domain_[d].lower + (*hint)[static_cast<Eigen::Index>(d)] * domain_[d].length();
    }
    const Result found =
        result_of(search_.nearest_from(p, start, {space_.periods[0] > 0, space_.periods[1] > 0}));
    if (found.distance <= std::min(tolerance, narrow_)) return found;
  }
  return result_of(search_.nearest(p));
}

// Three passes after the feet: a free parameter takes that of the foot before, then of the foot
// after, and turns are unwrapped. A path that is free everywhere keeps what the search gave.
SurfaceFoot::Path SurfaceFoot::along(std::span<const Point> points, double tolerance) const {
  Path result;
  std::vector<Foot> found;
  for (const Point& p : points) {
    std::optional<Eigen::Vector2d> hint;
    if (!found.empty() && !found.back().free[0] && !found.back().free[1])
      hint = found.back().parameters;
    const Result at = nearest(p, hint, tolerance);
    result.distance = std::max(result.distance, at.distance);
    found.push_back(at.foot);
  }
  for (std::size_t k = 1; k < found.size(); ++k) settle(found[k], found[k - 1]);
  for (std::size_t k = found.size(); k-- > 1;) settle(found[k - 1], found[k]);
  for (std::size_t k = 1; k < found.size(); ++k)
    unwrap(found[k].parameters, found[k - 1].parameters, space_);
  for (const Foot& foot : found) result.feet.push_back(foot.parameters);
  return result;
}

Eigen::Vector2d SurfaceFoot::beside(const Point& p, const Eigen::Vector2d& before,
                                    double tolerance) const {
  Foot foot = nearest(p, before, tolerance).foot;
  settle(foot, {before});
  unwrap(foot.parameters, before, space_);
  return foot.parameters;
}

}  // namespace knead::brep
