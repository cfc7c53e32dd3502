#include "knead/sculpt/domain_scaling.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "knead/spline/evaluate.hpp"

namespace knead {

Expected<DomainScaling> normalised_scaling(const Surface& rest) {
  std::array<BasisQuadrature, 2> q;
  for (int d = 0; d < 2; ++d) {
    q[static_cast<std::size_t>(d)] = gauss_basis(rest.knots(d), rest.knots(d).degree() + 4, 1);
  }
  double area = 0, total_u = 0, total_v = 0;
  // One span of u after the other, so that a large net needs no large memory.
  const int block = rest.knots(0).degree() + 4;
  for (int begin = 0; begin < q[0].basis.size(); begin += block) {
    const BasisTable rows = q[0].basis.slice(begin, begin + block);
    auto grid = evaluate_grid<2>(rest, std::array<const BasisTable*, 2>{&rows, &q[1].basis}, 1);
    if (!grid) return std::unexpected(grid.error());
    const Points& su = grid->at({1, 0});
    const Points& sv = grid->at({0, 1});
    Eigen::Index row = 0;
    for (int k = begin; k < begin + block; ++k) {
      for (double wv : q[1].weights) {
        const Point a = su.row(row), b = sv.row(row);
        const double w = q[0].weights[static_cast<std::size_t>(k)] * wv;
        area += w * a.cross(b).norm();
        total_u += w * a.norm();
        total_v += w * b.norm();
        ++row;
      }
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
