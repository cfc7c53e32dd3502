#include "knead/solve/eigenmodes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace knead {
namespace {

/// A chain of N masses between springs of stiffness 1: eigenvalues 2 − 2 cos(k π / (N + 1)), three
/// of each.
SparseMatrix chain(int points) {
  SparseMatrix k(points, points);
  for (int i = 0; i < points; ++i) {
    k.insert(i, i) = 2;
    if (i > 0) k.insert(i, i - 1) = k.insert(i - 1, i) = -1;
  }
  return on_coordinates(k);
}

SparseMatrix unit_mass(int points) {
  SparseMatrix m(3 * points, 3 * points);
  m.setIdentity();
  return m;
}

TEST(Eigenmodes, OfAChainAreExactWithAllCopies) {
  const int points = 100;
  const auto modes = vibration_modes(chain(points), unit_mass(points), {}, 9);
  ASSERT_TRUE(modes) << modes.error().message();
  ASSERT_EQ(modes->size(), 9U);
  for (std::size_t i = 0; i < 9; ++i) {
    const double exact =
        2 - 2 * std::cos((static_cast<double>(i / 3) + 1) * std::numbers::pi / (points + 1));
    // Rounding of K, whose norm is 4.
    EXPECT_NEAR((*modes)[i].value, exact, 1e-14) << i;
    EXPECT_LT((*modes)[i].residual, 1e-9) << i;
    EXPECT_NEAR((*modes)[i].shape.rowwise().norm().maxCoeff(), 1, 1e-14);
  }
}

TEST(Eigenmodes, ConstraintsAreKept) {
  // With its last point held the chain has one point less; its first points tied together swing
  // along.
  const int points = 40;
  const std::vector<LinearConstraint> held = {{"end", {{points - 1, 1.0}}}};
  const auto modes = vibration_modes(chain(points), unit_mass(points), held, 3);
  ASSERT_TRUE(modes) << modes.error().message();
  EXPECT_NEAR((*modes)[2].value, 2 - 2 * std::cos(std::numbers::pi / points), 1e-14);
  EXPECT_EQ((*modes)[0].shape.row(points - 1).norm(), 0);
}

TEST(Eigenmodes, OfFewUnknownsAreAllThereAre) {
  const auto modes = vibration_modes(chain(2), unit_mass(2), {}, 10);
  ASSERT_TRUE(modes) << modes.error().message();
  ASSERT_EQ(modes->size(), 6U);
  EXPECT_NEAR(modes->front().value, 1, 1e-14);
  EXPECT_NEAR(modes->back().value, 3, 1e-14);
}

TEST(Eigenmodes, BucklingFactorsAreThePositiveOnes) {
  // K + λ G is singular at λ = −1 / g for K = 1 and G = diag(g).
  const std::vector<double> g = {-0.5, 0.25, -0.125, 2, -1, 0};
  SparseMatrix geometric(6, 6);
  for (int i = 0; i < 6; ++i) geometric.insert(i, i) = g[static_cast<std::size_t>(i)];
  const auto modes = buckling_modes(unit_mass(2), geometric, {}, 5);
  ASSERT_TRUE(modes) << modes.error().message();
  ASSERT_EQ(modes->size(), 3U);
  EXPECT_NEAR((*modes)[0].value, 1, 1e-14);
  EXPECT_NEAR((*modes)[1].value, 2, 1e-14);
  EXPECT_NEAR((*modes)[2].value, 8, 1e-13);
}

TEST(Eigenmodes, ErrorsNameWhatIsWrong) {
  EXPECT_EQ(vibration_modes(chain(3), unit_mass(3), {}, 0).error().where, "count");
  EXPECT_EQ(vibration_modes(chain(3), SparseMatrix(9, 9), {}, 1).error().where, "density");
  EXPECT_EQ(buckling_modes(SparseMatrix(9, 9), chain(3), {}, 1).error().kind, ErrorKind::numerical);
  const std::vector<LinearConstraint> all = {{"a", {{0, 1.0}}}, {"b", {{1, 1.0}}}};
  EXPECT_FALSE(vibration_modes(chain(2), unit_mass(2), all, 1));
}

}  // namespace
}  // namespace knead
