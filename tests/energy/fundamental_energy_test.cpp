#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "knead/energy/shell_energy.hpp"
#include "knead/spline/evaluate.hpp"
#include "support/knot_families.hpp"
#include "support/surfaces.hpp"

// ∫ |G − G⁰|²_w1 + |B − B⁰|²_w2 du dv (thesis Eq. 3.42).

namespace knead {
namespace {

const FundamentalMaterial weights = {{2, 0.7, 1.1}, {0.3, 0.2, 0.5}};

Surface rest_shape(double weight_spread) {
  return testing::relief(testing::uniform_clamped(2, 2), testing::uniform_clamped(3, 2), 5, 0.2,
                         weight_spread);
}

Points moved(const Surface& rest) {
  return rest.control_points() + 0.1 * testing::random_points(rest.size(), 7);
}

/// The integral by its definition, with Gauss points of its own.
double by_definition(const Surface& rest, const Surface& now) {
  const BasisQuadrature u = gauss_basis(rest.knots(0), rest.knots(0).degree() + 1, 0),
                        v = gauss_basis(rest.knots(1), rest.knots(1).degree() + 1, 0);
  double sum = 0;
  for (std::size_t i = 0; i < u.weights.size(); ++i) {
    for (std::size_t j = 0; j < v.weights.size(); ++j) {
      const Parameters<2> at = (Parameters<2>(1, 2) << u.parameters[i], v.parameters[j]).finished();
      std::array<Eigen::Matrix2d, 2> first, second;
      for (std::size_t k = 0; k < 2; ++k) {
        const auto s = *evaluate<2>(k == 0 ? rest : now, at, 2);
        const Eigen::Vector3d a = s.at({1, 0}).row(0), b = s.at({0, 1}).row(0),
                              n = a.cross(b).normalized();
        first[k] << a.dot(a), a.dot(b), a.dot(b), b.dot(b);
        second[k] << n.dot(Eigen::Vector3d(s.at({2, 0}).row(0))),
            n.dot(Eigen::Vector3d(s.at({1, 1}).row(0))),
            n.dot(Eigen::Vector3d(s.at({1, 1}).row(0))),
            n.dot(Eigen::Vector3d(s.at({0, 2}).row(0)));
      }
      const auto weighted = [](const Eigen::Matrix2d& d, const std::array<double, 3>& w) {
        return w[0] * d(0, 0) * d(0, 0) + 2 * w[1] * d(0, 1) * d(0, 1) + w[2] * d(1, 1) * d(1, 1);
      };
      sum +=
          u.weights[i] * v.weights[j] *
          (weighted(first[1] - first[0], weights.w1) + weighted(second[1] - second[0], weights.w2));
    }
  }
  return sum;
}

TEST(FundamentalEnergy, IsItsDefinition) {
  for (const double spread : {1.0, 2.0}) {
    const Surface rest = rest_shape(spread);
    const auto energy = ShellEnergy::of_forms(rest, weights);
    ASSERT_TRUE(energy) << energy.error().message();
    const Points x = moved(rest);
    const auto now =
        Surface::create(rest.knots(), x, {rest.weights().begin(), rest.weights().end()});
    const double exact = by_definition(rest, *now);
    EXPECT_NEAR(energy->energy(x).sum(), exact, 1e-12 * exact);
    EXPECT_EQ(energy->energy(rest.control_points()).sum(), 0);
  }
}

TEST(FundamentalEnergy, DerivativesAreConsistent) {
  const Surface rest = rest_shape(2);
  const ShellEnergy energy = *ShellEnergy::of_forms(rest, weights);
  const Points x = moved(rest), d = testing::random_points(rest.size(), 11), g = energy.gradient(x);
  // Fourth-order differences: their error is of the order h⁴ and rounding / h.
  const double h = 1e-3;
  const auto w = [&](double t) { return energy.energy(x + t * d).sum(); };
  const double change = (8 * (w(h) - w(-h)) - (w(2 * h) - w(-2 * h))) / (12 * h);
  EXPECT_NEAR(g.cwiseProduct(d).sum(), change, 1e-8 * g.norm() * d.norm());
  const Points turned = (8 * (energy.gradient(x + h * d) - energy.gradient(x - h * d)) -
                         (energy.gradient(x + 2 * h * d) - energy.gradient(x - 2 * h * d))) /
                        (12 * h);
  const SparseMatrix hessian = energy.hessian(x);
  const Eigen::VectorXd product = hessian * Eigen::Map<const Eigen::VectorXd>(d.data(), d.size());
  EXPECT_LT((product - Eigen::Map<const Eigen::VectorXd>(turned.data(), turned.size())).norm(),
            1e-7 * product.norm());
}

TEST(FundamentalEnergy, RigidMotionsCostNothing) {
  const Surface rest = rest_shape(1);
  const ShellEnergy energy = *ShellEnergy::of_forms(rest, weights);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Points x =
      (rest.control_points() * turn.transpose()).rowwise() + Eigen::RowVector3d(3, -1, 2);
  EXPECT_LE(energy.energy(x).sum(), 1e-26 * energy.stretching_scale());
}

TEST(FundamentalEnergy, WeightsMustNotBeNegative) {
  const Surface rest = rest_shape(1);
  EXPECT_EQ(ShellEnergy::of_forms(rest, FundamentalMaterial{{1, -1, 1}, {1, 1, 1}}).error().where,
            "w1");
  EXPECT_EQ(ShellEnergy::of_forms(rest, FundamentalMaterial{{1, 1, 1}, {1, NAN, 1}}).error().where,
            "w2");
}

}  // namespace
}  // namespace knead
