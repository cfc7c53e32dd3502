// K, M, D and F of a surface on its free unknowns.
#include "knead/contact/free_system.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace knead::testing {
namespace {

KnotVector clamped(int degree, int count) { return *KnotVector::clamped_uniform(degree, count); }

/// A bent sheet of 5 x 6 control points over the unit square, rational where there are weights.
Surface bent(bool rational = false) {
  Points points(30, 3);
  std::vector<double> weights;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 6; ++j) {
      points.row(i * 6 + j) << 2 * i, 3 * j, 0.1 * i * i - 0.2 * i * j;
      if (rational) weights.push_back(1 + 0.1 * i + 0.05 * j * i);
    }
  }
  return *Surface::create({clamped(2, 5), clamped(3, 6)}, points, weights);
}

Material material() { return {{1, 0.3, 2}, {0.5, 0.25, 1}}; }

TEST(FreeUnknowns, AreTheControlPointsBetweenTheHeldRows) {
  EXPECT_EQ(free_unknowns({2, 3}, 0)->size(), 6u);
  EXPECT_EQ(*free_unknowns({4, 5}, 1), (std::vector<std::int64_t>{6, 7, 8, 11, 12, 13}));
  for (const int rows : {-1, 2, 2000000000}) EXPECT_FALSE(free_unknowns({4, 5}, rows)) << rows;
  EXPECT_EQ(free_unknowns({4, 5}, 2).error().what, "2 rows on each side leave nothing of 4 x 5");
}

TEST(FreeSystem, HasTheRowsAndColumnsOfTheWholeSystemThatAreFree) {
  for (const bool rational : {false, true}) {
    const Surface shape = bent(rational);
    const auto free = *free_unknowns(shape.net(), 1);
    const FreeSystem system(shape, free);
    const auto reduced = system.of(stretch_and_bend(material()));
    ASSERT_TRUE(reduced);
    const Eigen::MatrixXd whole(
        Stiffness<2>::create(shape, stretch_and_bend(material()))->assemble());
    const Eigen::MatrixXd part(reduced->matrix);
    ASSERT_EQ(part.rows(), 12);
    for (Eigen::Index i = 0; i < 12; ++i) {
      for (Eigen::Index j = 0; j < 12; ++j)
        EXPECT_EQ(part(i, j),
                  whole(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]));
    }
    EXPECT_EQ(part, part.transpose());
    EXPECT_EQ(reduced->error_bound == 0, !rational);
  }
}

TEST(FreeSystem, HasAStiffnessThatIsTheSumOfItsTerms) {
  const FreeSystem system(bent(), *free_unknowns({5, 6}, 0));
  const auto energies = system_energies(material(), 2, 3);
  const std::array<double, 6> coefficients = {1, 0.3, 2, 0.5, 0.25, 1};
  ASSERT_EQ(energies.size(), 9u);
  const auto matrix = [&](std::size_t k) {
    return Eigen::MatrixXd(system.of(energies[k].energy)->matrix);
  };
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(30, 30);
  for (std::size_t k = 0; k < 6; ++k) sum += coefficients[k] * matrix(k + 1);
  EXPECT_LE((matrix(0) - sum).norm(), 1e-14 * sum.norm());  // sums of 6 terms
  EXPECT_LE((matrix(8) * 2 - matrix(7) * 3).norm(), 1e-15 * matrix(8).norm())
      << "both are of the same integrals";
  EXPECT_EQ(energies[4].name, "K_beta11");
}

// A shape that moves as a whole has no energy; mass and load add up to those of the domain, here
// the unit square.
TEST(FreeSystem, KnowsRigidMotionMassAndLoad) {
  for (const bool rational : {false, true}) {
    const Surface shape = bent(rational);
    const FreeSystem system(shape, *free_unknowns(shape.net(), 0));
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(30);
    const auto stiffness = system.of(stretch_and_bend(material()));
    EXPECT_LT((stiffness->matrix * ones).norm(), 1e-12 * stiffness->matrix.norm());
    // The tolerance of rational integrals; rounding.
    const double accuracy = rational ? 1e-8 : 1e-14;
    EXPECT_NEAR(ones.dot(system.of(mass_energy<2>(7))->matrix * ones), 7, 7 * accuracy);
    const auto forces = system.forces({1, -2, 3});
    ASSERT_TRUE(forces);
    EXPECT_LT((forces->colwise().sum() - Eigen::RowVector3d(1, -2, 3)).norm(), 4 * accuracy);
    EXPECT_EQ(system.points(), shape.control_points());
  }
}

// In normalised units a sheet and its copy of another size and parametrisation give the same
// numbers.
TEST(FreeSystem, DoesNotDependOnSizeInNormalisedUnits) {
  const Surface shape = bent();
  std::array<KnotVector, 2> knots = shape.knots();
  for (KnotVector& k : knots) {
    std::vector<double> stretched(k.knots().begin(), k.knots().end());
    for (double& x : stretched) x = 4 * x + 1;
    k = *KnotVector::create(k.degree(), stretched);
  }
  const Surface larger = *Surface::create(knots, 8 * shape.control_points());
  const auto system = [](const Surface& s) {
    return FreeSystem(s, *free_unknowns(s.net(), 1), *normalised_scaling<2>(s));
  };
  const FreeSystem a = system(shape), b = system(larger);
  const Eigen::MatrixXd k(a.of(stretch_and_bend(material()))->matrix),
      l(b.of(stretch_and_bend(material()))->matrix);
  EXPECT_LT((k - l).norm(), 1e-12 * k.norm());
  EXPECT_LT((a.points() - b.points()).norm(), 1e-12 * a.points().norm());
  EXPECT_LT((*a.forces({0, 0, 1}) - *b.forces({0, 0, 1})).norm(), 1e-12);
}

}  // namespace
}  // namespace knead::testing
