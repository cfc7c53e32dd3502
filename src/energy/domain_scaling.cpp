#include "knead/energy/domain_scaling.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

template <int D>
double measure(const std::array<Point, D>& tangents) {
  if constexpr (D == 1) return tangents[0].norm();
  if constexpr (D == 2) return tangents[0].cross(tangents[1]).norm();
  if constexpr (D == 3) return std::abs(tangents[0].cross(tangents[1]).dot(tangents[2]));
}

constexpr const char* measure_name[] = {"length", "area", "volume"};

}  // namespace

// Energies of derivatives by parameters depend on how long the parameters are: a strip of 10 : 1
// over [0, 1]² would stretch a dent 10 : 1. Each direction is scaled by the mean length of its
// isocurves, in units of the root of the area, so that α and β mean the same on every surface and
// in every unit. Norms of tangents are no polynomials: p + 4 Gauss points per span.
template <int D>
Expected<DomainScaling<D>> normalised_scaling(const Spline<D>& rest) {
  std::array<BasisQuadrature, D> q;
  std::array<const BasisTable*, D> tables;
  double domain = 1;
  for (std::size_t d = 0; d < D; ++d) {
    q[d] = gauss_basis(rest.knots()[d], rest.knots()[d].degree() + 4, 1);
    tables[d] = &q[d].basis;
    domain *= rest.knots()[d].domain().length();
  }
  std::vector<double> weights = {1};  // of the points that have one index of the first direction
  for (std::size_t d = 1; d < D; ++d) {
    std::vector<double> further;
    for (const double w : weights) {
      for (const double weight : q[d].weights) further.push_back(weight * w);
    }
    weights = std::move(further);
  }
  double total = 0;
  std::array<double, D> lengths{};
  // One span of the first direction at a time, so that a large net does not need much memory.
  const int block = rest.knots(0).degree() + 4;
  Evaluation<D> grid;
  for (int begin = 0; begin < q[0].basis.size(); begin += block) {
    const BasisTable rows = q[0].basis.slice(begin, begin + block);
    tables[0] = &rows;
    if (auto status = evaluate_grid<D>(rest, tables, 1, grid); !status)
      return std::unexpected(status.error());
    std::array<const Points*, D> derivatives;
    for (std::size_t d = 0; d < D; ++d) {
      MultiIndex<D> first{};
      first[d] = 1;
      derivatives[d] = &grid.at(first);
    }
    Eigen::Index row = 0;
    for (int k = begin; k < begin + block; ++k) {
      for (const double inner : weights) {
        const double w = inner * q[0].weights[static_cast<std::size_t>(k)];
        std::array<Point, D> tangents;
        for (std::size_t d = 0; d < D; ++d) {
          tangents[d] = derivatives[d]->row(row);
          lengths[d] += w * tangents[d].norm();
        }
        total += w * measure<D>(tangents);
        ++row;
      }
    }
  }
  if (!(total > 0) || !std::isfinite(total)) {
    return numerical_error(std::string("the shape has no ") + measure_name[D - 1], {},
                           "choose one that is not collapsed");
  }
  DomainScaling<D> scaling;
  scaling.length = D == 1 ? total : D == 2 ? std::sqrt(total) : std::cbrt(total);
  // Mean isocurve length over the other directions, in units of `length`, per unit of its own
  // parameter.
  for (std::size_t d = 0; d < D; ++d) scaling.factors[d] = lengths[d] / domain / scaling.length;
  return scaling;
}

template <int D>
DomainScaling<D> in_unit(const DomainScaling<D>& scaling, double length) {
  DomainScaling<D> result = scaling;
  result.length = length;
  for (double& factor : result.factors) factor *= scaling.length / length;
  return result;
}

template Expected<DomainScaling<1>> normalised_scaling<1>(const Spline<1>&);
template Expected<DomainScaling<2>> normalised_scaling<2>(const Spline<2>&);
template Expected<DomainScaling<3>> normalised_scaling<3>(const Spline<3>&);
template DomainScaling<1> in_unit<1>(const DomainScaling<1>&, double);
template DomainScaling<2> in_unit<2>(const DomainScaling<2>&, double);
template DomainScaling<3> in_unit<3>(const DomainScaling<3>&, double);

}  // namespace knead
