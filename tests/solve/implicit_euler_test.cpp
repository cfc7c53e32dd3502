#include "knead/solve/implicit_euler.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>

#include "support/surfaces.hpp"

namespace knead {
namespace {

using testing::random_points;

struct Problem {
  Surface surface;
  SparseMatrix k, mass, identity;

  explicit Problem(Surface s, const Material& material = {}) : surface(std::move(s)) {
    k = Stiffness<2>::create(surface, stretch_and_bend(material))->assemble();
    mass = Stiffness<2>::create(surface, mass_energy<2>())->assemble();
    identity.resize(surface.size(), surface.size());
    identity.setIdentity();
  }
};

TEST(SparseCholesky, SolvesToTheAccuracyOfADenseFactorisation) {
  const Problem p(testing::relief(testing::uniform_clamped(3, 6), testing::uniform_clamped(2, 7), 1));
  const SparseMatrix a = p.k + p.mass;
  const auto cholesky = SparseCholesky::factor(a);
  ASSERT_TRUE(cholesky);
  const Points x = random_points(a.rows(), 2), b = a * x;
  EXPECT_LE((cholesky->solve(b) - x).norm(), 1e-12 * x.norm());
  // Backward error: what a stable solver promises whatever the condition number.
  EXPECT_LE((a * cholesky->solve(b) - b).norm(), 1e-14 * Eigen::MatrixXd(a).norm() * x.norm());
}

TEST(SparseCholesky, RefusesWhatIsNotPositiveDefinite) {
  SparseMatrix a(2, 2);
  a.insert(0, 0) = 1;
  a.insert(1, 1) = -1;
  auto failed = SparseCholesky::factor(a);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().kind, ErrorKind::numerical);
  a.coeffRef(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(SparseCholesky::factor(a));
}

TEST(ImplicitEuler, SatisfiesTheEquationOfTheStep) {
  const Problem p(testing::relief(testing::uniform_clamped(3, 5), testing::uniform_clamped(3, 4), 3));
  const Points before = random_points(p.surface.size(), 4), force = random_points(p.surface.size(), 5);
  for (const SparseMatrix* w : {&p.mass, &p.identity}) {
    for (double lambda : {1e-3, 1.0, 1e3}) {
      const auto euler = ImplicitEuler::create(p.k, *w, lambda, Partition(p.surface.size()));
      ASSERT_TRUE(euler);
      const Points after = euler->step(before, force);
      const Points left = p.k * after + lambda * (*w * after), right = lambda * (*w * before) + force;
      EXPECT_LE((left - right).norm(), 1e-12 * (euler->system().norm() * after.norm()));
    }
  }
}

TEST(ImplicitEuler, EnergyNeverGrowsWithoutForce) {
  for (const Surface& s :
       {testing::relief(testing::uniform_clamped(3, 5), testing::uniform_clamped(2, 6), 6), testing::cylinder(),
        testing::sphere(),
        testing::relief(testing::uniform_unclamped(2, 4), testing::uniform_clamped(3, 3), 9, 0.2, 30)}) {
    const Problem p(s, {{1, 0.5, 1}, {0.1, 0.2, 0.3}});
    for (const SparseMatrix* w : {&p.mass, &p.identity}) {
      for (double lambda : {0.01, 1.0, 100.0}) {
        const auto euler = ImplicitEuler::create(p.k, *w, lambda, Partition(s.size()));
        ASSERT_TRUE(euler);
        Points x = random_points(s.size(), 8);
        double energy = x.cwiseProduct(p.k * x).sum();
        const double rounding = 1e-15 * p.k.norm() * x.squaredNorm();  // of the sums that the energy is
        for (int step = 0; step < 20; ++step) {
          x = euler->step(x, Points::Zero(s.size(), 3));
          const double next = x.cwiseProduct(p.k * x).sum();
          EXPECT_LE(next, energy + rounding);
          energy = next;
        }
      }
    }
  }
}

TEST(ImplicitEuler, CollapsesAFreeSurfaceToAPointAsTheThesisSays) {
  const Problem p(testing::uniform_sheet(3, 8, 8));
  const auto euler = ImplicitEuler::create(p.k, p.mass, 0.1, Partition(p.surface.size()));
  Points x = p.surface.control_points();
  for (int step = 0; step < 60; ++step) x = euler->step(x, Points::Zero(x.rows(), 3));
  EXPECT_LT((x.rowwise() - x.colwise().mean()).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_NEAR(x.col(0).mean(), 0.5, 1e-10);  // W = mass: the centre of mass stays
}

TEST(ImplicitEuler, FixedRowsKeepTheirBits) {
  const Problem p(testing::relief(testing::uniform_clamped(3, 5), testing::uniform_clamped(3, 5), 10));
  std::vector<bool> fixed(static_cast<std::size_t>(p.surface.size()));
  for (std::size_t i = 0; i < fixed.size(); i += 3) fixed[i] = true;
  const auto euler = ImplicitEuler::create(p.k, p.mass, 1, Partition(fixed));
  ASSERT_TRUE(euler);
  const Points before = random_points(p.surface.size(), 11);
  const Points after = euler->step(before, random_points(p.surface.size(), 12));
  for (int i = 0; i < p.surface.size(); ++i) {
    if (fixed[static_cast<std::size_t>(i)]) {
      EXPECT_EQ(after.row(i), before.row(i));
    } else {
      EXPECT_NE(after.row(i), before.row(i));
    }
  }
}

TEST(ImplicitEuler, EliminationIsExact) {
  // The free rows satisfy their own equations with the fixed values put in.
  const Problem p(testing::relief(testing::uniform_clamped(2, 5), testing::uniform_clamped(2, 5), 13));
  std::vector<bool> fixed(static_cast<std::size_t>(p.surface.size()));
  for (std::size_t i = 0; i < 10; ++i) fixed[i] = true;
  const Partition partition(fixed);
  const auto euler = ImplicitEuler::create(p.k, p.mass, 2, partition);
  const Points before = random_points(p.surface.size(), 14), force = random_points(p.surface.size(), 15);
  const Points after = euler->step(before, force);
  const Points residual = p.k * after + 2 * (p.mass * (after - before)) - force;
  EXPECT_LE(partition.gather(residual).norm(), 1e-12 * euler->system().norm() * after.norm());
}

TEST(ImplicitEuler, WithEverythingFixedNothingMoves) {
  const Problem p(testing::uniform_sheet(2, 4, 4));
  const auto euler = ImplicitEuler::create(p.k, p.mass, 1, Partition(std::vector<bool>(16, true)));
  ASSERT_TRUE(euler);
  const Points before = random_points(16, 1);
  EXPECT_EQ(euler->step(before, random_points(16, 2)), before);
}

TEST(ImplicitEuler, RefusesABadLambdaAndASingularSystem) {
  const Problem p(testing::uniform_sheet(2, 4, 4));
  EXPECT_EQ(ImplicitEuler::create(p.k, p.mass, -1, Partition(16)).error().kind, ErrorKind::input);
  EXPECT_EQ(ImplicitEuler::create(p.k, p.mass, std::nan(""), Partition(16)).error().where, "lambda");
  const SparseMatrix zero(16, 16);
  EXPECT_EQ(ImplicitEuler::create(zero, p.mass, 0, Partition(16)).error().kind, ErrorKind::numerical);
}

}  // namespace
}  // namespace knead
