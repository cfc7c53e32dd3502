#include "surface_forces.hpp"

#include <Eigen/Geometry>

#include "knead/spline/evaluate.hpp"

namespace knead {

Expected<Points> normal_forces(const Surface& surface, const DomainScaling<2>& scaling,
                               const Points& points, const Points& velocity, double pressure,
                               const Point& wind) {
  std::array<BasisQuadrature, 2> q;
  for (std::size_t d = 0; d < 2; ++d)
    q[d] = gauss_basis(surface.knots()[d], surface.knots()[d].degree() + 1, 1);
  const std::array<const BasisTable*, 2> tables = {&q[0].basis, &q[1].basis};
  const auto shape = surface.with_control_points(points);
  if (!shape) return std::unexpected(shape.error());
  const auto at = evaluate_grid<2>(*shape, tables, 1);
  if (!at) return std::unexpected(at.error());
  Points speed = Points::Zero(at->points().rows(), 3);
  if (velocity.rows() > 0) {
    const auto field = surface.with_control_points(velocity);
    if (!field) return std::unexpected(field.error());
    const auto moving = evaluate_grid<2>(*field, tables, 0);
    if (!moving) return std::unexpected(moving.error());
    speed = moving->points();
  }
  const int n = surface.net()[1], nv = q[1].basis.size();
  Points result = Points::Zero(surface.size(), 3);
  for (int k = 0; k < q[0].basis.size(); ++k) {
    for (int l = 0; l < nv; ++l) {
      const Eigen::Index row = static_cast<Eigen::Index>(k) * nv + l;
      const Point cross = Point(at->at({1, 0}).row(row)).cross(Point(at->at({0, 1}).row(row)));
      const double length = cross.norm();
      if (!(length > 0)) continue;
      const Point normal = cross / length;
      const double strength = pressure + normal.dot(wind - speed.row(row).transpose());
      const double weight = scaling.factors[0] * q[0].weights[static_cast<std::size_t>(k)] *
                            scaling.factors[1] * q[1].weights[static_cast<std::size_t>(l)];
      // R_i = w_i N_i / Σ w N
      const double *nu = q[0].basis.row(k, 0), *nl = q[1].basis.row(l, 0);
      const int i0 = q[0].basis.first[static_cast<std::size_t>(k)],
                j0 = q[1].basis.first[static_cast<std::size_t>(l)];
      const auto weight_of = [&](int i) {
        return surface.rational() ? surface.weights()[static_cast<std::size_t>(i)] : 1;
      };
      double denominator = 0;
      for (int r = 0; r <= q[0].basis.degree; ++r) {
        for (int c = 0; c <= q[1].basis.degree; ++c)
          denominator += nu[r] * nl[c] * weight_of((i0 + r) * n + j0 + c);
      }
      for (int r = 0; r <= q[0].basis.degree; ++r) {
        for (int c = 0; c <= q[1].basis.degree; ++c) {
          const int i = (i0 + r) * n + j0 + c;
          result.row(i) +=
              (weight * strength * nu[r] * nl[c] * weight_of(i) / denominator) * normal.transpose();
        }
      }
    }
  }
  return result;
}

}  // namespace knead
