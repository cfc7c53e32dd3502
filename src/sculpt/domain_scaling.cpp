#include "knead/sculpt/domain_scaling.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "knead/spline/evaluate.hpp"

namespace knead {

Expected<DomainScaling> normalised_scaling(const Surface& rest) {
  std::array<BasisQuadrature, 2> q;
  for (int d = 0; d < 2; ++d) {
    q[static_cast<std::size_t>(d)] = gauss_basis(rest.knots(d), rest.knots(d).degree() + 1, 1);
  }
  auto grid = evaluate_grid<2>(rest, std::array<const BasisTable*, 2>{&q[0].basis, &q[1].basis}, 1);
  if (!grid) return std::unexpected(grid.error());
  const Points& su = grid->at({1, 0});
  const Points& sv = grid->at({0, 1});
  double area = 0, total_u = 0, total_v = 0;
  Eigen::Index row = 0;
  for (double wu : q[0].weights) {
    for (double wv : q[1].weights) {
      const Point a = su.row(row), b = sv.row(row);
      area += wu * wv * a.cross(b).norm();
      total_u += wu * wv * a.norm();
      total_v += wu * wv * b.norm();
      ++row;
    }
  }
  if (!(area > 0) || !std::isfinite(area)) {
    return numerical_error("the surface has no area", {}, "choose a surface that is not collapsed to a curve or point");
  }
  const double length = std::sqrt(area);
  const double range_u = rest.knots(0).domain().length(), range_v = rest.knots(1).domain().length();
  // Mean isocurve length over the other direction, in units of `length`, per unit of its own parameter.
  return DomainScaling{length, {total_u / (range_u * range_v) / length, total_v / (range_u * range_v) / length}};
}

}  // namespace knead
