#include "energy/form_energy.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "knead/spline/curvature.hpp"
#include "support/knot_families.hpp"
#include "support/surfaces.hpp"

// Energies of the fundamental forms of curves and volumes (thesis Eqs. 3.19 to 3.22).

namespace knead {
namespace {

using Real = long double;
using Real3 = Eigen::Matrix<Real, 3, 1>;

std::vector<double> spread_weights(int count, double spread) {
  std::vector<double> weights;
  if (spread == 1) return weights;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int i = 0; i < count; ++i) weights.push_back(std::pow(spread, value(random)));
  return weights;
}

/// A curve that is bent everywhere.
Curve bent_curve(double spread) {
  const KnotVector k = testing::uniform_clamped(3, 4);
  Points x(k.count(), 3);
  for (int i = 0; i < k.count(); ++i) x.row(i) << std::cos(0.5 * i), std::sin(0.5 * i), 0.1 * i;
  return *Curve::create({k}, x, spread_weights(k.count(), spread));
}

Volume block(double spread) {
  const KnotVector u = testing::uniform_clamped(2, 2), v = testing::uniform_clamped(2, 1),
                   w = testing::uniform_clamped(1, 2);
  Points x(u.count() * v.count() * w.count(), 3);
  int row = 0;
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j) {
      for (int k = 0; k < w.count(); ++k) x.row(row++) << i, 0.7 * j, 0.5 * k;
    }
  }
  x += 0.1 * testing::random_points(x.rows(), 13);
  return *Volume::create({u, v, w}, x, spread_weights(static_cast<int>(x.rows()), spread));
}

/// ∂^a S of order 1 and 2 in extended precision from the derivatives in double.
Real3 extended(const Points& rows) { return rows.row(0).transpose().cast<Real>(); }

Real density(const Curve& rest, const Curve& now, const std::array<double, 1>& u,
             const FormWeights& weights) {
  const auto jet = [&](const Curve& s) {
    const auto e = *evaluate<1>(s, Parameters<1>{{u[0]}}, 2);
    const Real3 a = extended(e.at({1})), b = extended(e.at({2}));
    return std::array<Real, 2>{a.dot(a), a.cross(b).norm() / (a.norm() * a.dot(a))};
  };
  const auto [s0, k0] = jet(rest);
  const auto [s1, k1] = jet(now);
  return weights.w1 * (s1 - s0) * (s1 - s0) + weights.w2 * (k1 - k0) * (k1 - k0);
}

Real density(const Volume& rest, const Volume& now, const std::array<double, 3>& u,
             const FormWeights& weights) {
  const auto metric = [&](const Volume& s) {
    const auto e = *evaluate<3>(s, Parameters<3>{{u[0], u[1], u[2]}}, 1);
    Eigen::Matrix<Real, 3, 3> a;
    a << extended(e.at({1, 0, 0})), extended(e.at({0, 1, 0})), extended(e.at({0, 0, 1}));
    return Eigen::Matrix<Real, 3, 3>(a.transpose() * a);
  };
  return weights.w1 * (metric(now) - metric(rest)).squaredNorm();
}

/// The integral by its definition, with these Gauss points per span.
template <int D>
double by_definition(const Spline<D>& rest, const Spline<D>& now, const FormWeights& weights,
                     int points) {
  std::array<BasisQuadrature, D> q;
  std::size_t total = 1;
  for (std::size_t d = 0; d < D; ++d) {
    q[d] = gauss_basis(rest.knots()[d], points, 0);
    total *= q[d].weights.size();
  }
  Real sum = 0;
  for (std::size_t k = 0; k < total; ++k) {
    std::array<double, D> u;
    Real weight = 1;
    for (std::size_t d = 0, left = k; d < D; ++d) {
      const std::size_t at = left % q[d].weights.size();
      left /= q[d].weights.size();
      u[d] = q[d].parameters[at];
      weight *= q[d].weights[at];
    }
    sum += weight * density(rest, now, u, weights);
  }
  return static_cast<double>(sum);
}

template <int D>
Spline<D> at(const Spline<D>& like, const Points& x) {
  return *Spline<D>::create(like.knots(), x, {like.weights().begin(), like.weights().end()});
}

template <int D>
void check_all(const Spline<D>& rest) {
  const FormWeights weights = {1.3, 0.2};
  constexpr int points = 5;
  const auto energy = FormEnergy<D>::create(rest, weights, points);
  ASSERT_TRUE(energy) << energy.error().message();
  EXPECT_EQ(energy->energy(rest.control_points()).sum(), 0);
  const Points x = rest.control_points() + 0.1 * testing::random_points(rest.size(), 7);
  const double exact = by_definition<D>(rest, at<D>(rest, x), weights, points);
  EXPECT_NEAR(energy->energy(x).sum(), exact, 1e-12 * exact);

  // Fourth-order differences: their error is of the order h⁴ and rounding / h.
  const Points d = testing::random_points(rest.size(), 11), g = energy->gradient(x);
  const double h = 1e-3;
  const auto w = [&](double t) { return energy->energy(x + t * d).sum(); };
  const double change = (8 * (w(h) - w(-h)) - (w(2 * h) - w(-2 * h))) / (12 * h);
  EXPECT_NEAR(g.cwiseProduct(d).sum(), change, 1e-8 * g.norm() * d.norm());
  const Points turned = (8 * (energy->gradient(x + h * d) - energy->gradient(x - h * d)) -
                         (energy->gradient(x + 2 * h * d) - energy->gradient(x - 2 * h * d))) /
                        (12 * h);
  const SparseMatrix hessian = energy->hessian(x);
  const Eigen::VectorXd product = hessian * Eigen::Map<const Eigen::VectorXd>(d.data(), d.size());
  EXPECT_LT((product - Eigen::Map<const Eigen::VectorXd>(turned.data(), turned.size())).norm(),
            1e-7 * product.norm());
  EXPECT_EQ((hessian - SparseMatrix(hessian.transpose())).norm(), 0);

  // At rest nothing is strained: both Hessians are the same, and not negative in any direction.
  const SparseMatrix at_rest = energy->hessian(rest.control_points()),
                     material = energy->material_hessian(rest.control_points());
  EXPECT_LT((at_rest - material).norm(), 1e-11 * material.norm());
  for (const Points* place : {&rest.control_points(), &x}) {
    for (const SparseMatrix& part :
         {energy->material_hessian(*place), energy->tense_hessian(*place)}) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(Eigen::MatrixXd(part),
                                                                    Eigen::EigenvaluesOnly);
      EXPECT_GT(spectrum.eigenvalues()[0], -1e-12 * spectrum.eigenvalues().maxCoeff());
    }
  }

  // Stretched in all directions, nothing is left out of the metric's.
  const FormEnergy<D> metric = *FormEnergy<D>::create(rest, {1.3, 0}, points);
  const SparseMatrix stretched = metric.hessian(1.5 * rest.control_points());
  EXPECT_LT((stretched - metric.tense_hessian(1.5 * rest.control_points())).norm(),
            1e-13 * stretched.norm());
  EXPECT_GT((stretched - metric.material_hessian(1.5 * rest.control_points())).norm(),
            1e-2 * stretched.norm());

  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Points moved =
      (rest.control_points() * turn.transpose()).rowwise() + Eigen::RowVector3d(3, -1, 2);
  EXPECT_LE(energy->energy(moved).sum(), 1e-26 * energy->stretching_scale());
}

TEST(FormEnergy, OfCurvesIsItsDefinitionWithItsDerivatives) {
  for (const double spread : {1.0, 2.0}) check_all<1>(bent_curve(spread));
}

TEST(FormEnergy, OfVolumesIsItsDefinitionWithItsDerivatives) {
  for (const double spread : {1.0, 2.0}) check_all<3>(block(spread));
}

TEST(FormEnergy, OfPolynomialVolumesIsExact) {
  const Volume rest = block(1);
  const Points x = rest.control_points() + 0.1 * testing::random_points(rest.size(), 7);
  const FormEnergy<3> standard = *FormEnergy<3>::create(rest, {}),
                      more = *FormEnergy<3>::create(rest, {}, 9);
  EXPECT_NEAR(standard.energy(x).sum(), more.energy(x).sum(), 1e-13 * more.energy(x).sum());
}

TEST(FormEnergy, OfAVolumeIsFreeOfOtherZeroModesThanTheRigidOnes) {
  const Volume rest = block(1);
  const FormEnergy<3> energy = *FormEnergy<3>::create(rest, {});
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(
      Eigen::MatrixXd(energy.hessian(rest.control_points())), Eigen::EigenvaluesOnly);
  const double largest = spectrum.eigenvalues().maxCoeff();
  EXPECT_LT(spectrum.eigenvalues()[5], 1e-13 * largest);
  EXPECT_GT(spectrum.eigenvalues()[6], 1e-6 * largest);
}

TEST(FormEnergy, OfAStraightCurveIsThatOfStretchAndBend) {
  // S = (L u, 0, 0) to (λ L u, 0, 0): w1 (λ² − 1)² L⁴; to a circle of radius R at the same speed:
  // w2 / R².
  const KnotVector k = *KnotVector::clamped_uniform(2, 3);
  const Curve rest = *Curve::create({k}, (Points(3, 3) << 0, 0, 0, 1, 0, 0, 2, 0, 0).finished());
  const FormEnergy<1> energy = *FormEnergy<1>::create(rest, {3, 5});
  Points x = rest.control_points() * 1.1;
  EXPECT_NEAR(energy.energy(x).membrane, 3 * std::pow(1.21 - 1, 2) * 16, 1e-13);
  EXPECT_EQ(energy.energy(x).bending, 0);
  EXPECT_TRUE(energy.gradient(x).allFinite());
  // y = c (2u)²/2: curvature c to its second order at a small c.
  const double c = 1e-6;
  x = rest.control_points();
  x.col(1) << 0, 0, 2 * c;
  EXPECT_NEAR(energy.energy(x).bending, 5 * c * c, 1e-9 * 5 * c * c);
}

TEST(FormEnergy, NamesWhatIsWrong) {
  const Curve line = *Curve::create({*KnotVector::clamped_uniform(1, 3)},
                                    (Points(3, 3) << 0, 0, 0, 1, 0, 0, 2, 1, 0).finished());
  EXPECT_EQ(FormEnergy<1>::create(line, {1, 1}).error().where, "w2");
  EXPECT_TRUE(FormEnergy<1>::create(line, {1, 0}));
  EXPECT_EQ(FormEnergy<3>::create(block(1), {-1, 0}).error().where, "w1");
  const Curve point = *Curve::create({*KnotVector::clamped_uniform(2, 3)}, Points::Zero(3, 3));
  EXPECT_EQ(FormEnergy<1>::create(point, {}).error().kind, ErrorKind::numerical);
}

}  // namespace
}  // namespace knead
