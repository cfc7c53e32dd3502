#include "solve/constraint_space.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>

#include "support/surfaces.hpp"

namespace knead {
namespace {

using testing::random_points;

/// Random constraints on few unknowns each, their right sides those of a known solution.
struct RandomConstraints {
  Points solution;
  std::vector<LinearConstraint> constraints;

  RandomConstraints(int size, int count, unsigned seed, bool normals)
      : solution(random_points(size, seed)) {
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<int> unknown(0, size - 1), length(1, 5);
    std::uniform_real_distribution<double> coefficient(-2, 2);
    for (int k = 0; k < count; ++k) {
      LinearConstraint c;
      c.name = "constraint " + std::to_string(k);
      for (int t = length(random); t > 0; --t)
        c.terms.emplace_back(unknown(random), coefficient(random));
      for (const auto& [i, a] : c.terms) c.value += a * solution.row(i).transpose();
      if (normals && k % 3 == 0)
        c.normal = Point(coefficient(random), coefficient(random), coefficient(random));
      constraints.push_back(c);
    }
  }
};

TEST(ConstraintSpace, EveryMemberSatisfiesTheConstraints) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    for (bool normals : {false, true}) {
      const int size = 8 + static_cast<int>(seed) % 30;
      const RandomConstraints r(size, static_cast<int>(seed) % size, seed, normals);
      const auto space = ConstraintSpace::create(size, r.constraints);
      ASSERT_TRUE(space) << "seed " << seed << ": " << space.error().message();
      const Points any = random_points(size, seed + 1000);
      const Points member = space->feasible(any);
      EXPECT_LT(space->violation(member), 1e-10) << "seed " << seed;
      // T y leaves every constraint as it is.
      const Eigen::MatrixXd y =
          Eigen::MatrixXd::Random(space->free_count(), space->coupled() ? 1 : 3);
      EXPECT_LT(space->violation(member + space->expand(y)), 1e-9) << "seed " << seed;
      // And nothing is lost: the known solution is a member.
      EXPECT_LT((space->feasible(r.solution) - r.solution).cwiseAbs().maxCoeff(), 1e-9)
          << "seed " << seed;
    }
  }
}

TEST(ConstraintSpace, LeavesTheFreedomThatTheRankSays) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const int size = 12;
    RandomConstraints r(size, 7, seed, false);
    r.constraints.push_back(r.constraints[0]);  // said twice
    Eigen::MatrixXd c =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(r.constraints.size()), size);
    for (std::size_t k = 0; k < r.constraints.size(); ++k) {
      for (const auto& [i, a] : r.constraints[k].terms) c(static_cast<Eigen::Index>(k), i) += a;
    }
    const auto space = ConstraintSpace::create(size, r.constraints);
    ASSERT_TRUE(space);
    EXPECT_EQ(space->free_count(), size - c.fullPivLu().rank()) << "seed " << seed;
  }
}

TEST(ConstraintSpace, ReduceIsTheTransposeOfExpandAndRestrictTheirProduct) {
  for (bool normals : {false, true}) {
    const RandomConstraints r(10, 4, 7, normals);
    std::vector<bool> held(10, false);
    held[3] = true;
    const auto with_held = ConstraintSpace::create(10, r.constraints, held);
    ASSERT_TRUE(with_held);
    const int width = with_held->coupled() ? 1 : 3;
    const Eigen::MatrixXd y = Eigen::MatrixXd::Random(with_held->free_count(), width);
    const Points b = random_points(10, 9);
    EXPECT_NEAR(with_held->reduce(b).cwiseProduct(y).sum(),
                b.cwiseProduct(with_held->expand(y)).sum(), 1e-13);
    EXPECT_LT((with_held->reduce(with_held->lumped(b)) - with_held->reduce(b)).norm(), 1e-13);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Random(10, 10);
    dense = (dense + dense.transpose()).eval();
    const SparseMatrix a = dense.sparseView();
    const Eigen::MatrixXd expected = with_held->reduce(Points(dense * with_held->expand(y)));
    EXPECT_LT((Eigen::MatrixXd(with_held->restrict(a)) * y - expected).norm(), 1e-12);
  }
}

TEST(ConstraintSpace, HeldUnknownsKeepTheirBitsAndCarryOthers) {
  std::vector<bool> held(4, false);
  held[1] = true;
  // X_0 = X_1, X_2 + X_3 = 2 X_1.
  const std::vector<LinearConstraint> constraints = {{"same", {{0, 1}, {1, -1}}},
                                                     {"mean", {{2, 1}, {3, 1}, {1, -2}}}};
  const auto space = ConstraintSpace::create(4, constraints, held);
  ASSERT_TRUE(space);
  EXPECT_EQ(space->free_count(), 1);
  EXPECT_TRUE(space->is_determined(1));
  EXPECT_TRUE(space->is_determined(0));
  EXPECT_FALSE(space->is_determined(3));
  Points x = random_points(4, 3);
  const Points member = space->feasible(x);
  EXPECT_EQ(member.row(1), x.row(1));
  EXPECT_EQ(member.row(0), x.row(1));
  EXPECT_LT(space->violation(member), 1e-15);
  EXPECT_EQ(space->expand(Eigen::MatrixXd::Ones(1, 3)).row(1).norm(), 0);
}

TEST(ConstraintSpace, IsTheSameOverCoordinates) {
  const std::vector<bool> held = {false, true, false, false, false};
  const std::vector<LinearConstraint> constraints = {{"a", {{0, 1}, {1, -1}}, Point(1, 2, 3)},
                                                     {"b", {{2, 1}, {3, 2}}}};
  const auto space = ConstraintSpace::create(5, constraints, held);
  ASSERT_TRUE(space);
  const ConstraintSpace coordinates = space->on_coordinates();
  EXPECT_TRUE(coordinates.coupled());
  ASSERT_EQ(coordinates.free_count(), 3 * space->free_count());
  const Points x = random_points(5, 3), y = random_points(space->free_count(), 4);
  EXPECT_EQ(coordinates.feasible(x), space->feasible(x));
  EXPECT_EQ(coordinates.expand(Eigen::Map<const Eigen::VectorXd>(y.data(), y.size())),
            space->expand(y));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(coordinates.is_determined(i), space->is_determined(i));
  EXPECT_EQ(coordinates.on_coordinates().expand(Eigen::VectorXd::Ones(coordinates.free_count())),
            coordinates.expand(Eigen::VectorXd::Ones(coordinates.free_count())));
}

TEST(ConstraintSpace, RedundantConstraintsAreFineAndContradictoryOnesAreNamed) {
  const LinearConstraint first{"edge u0", {{0, 1}}, Point(1, 0, 0)},
      second{"seam", {{0, 1}, {1, -1}}}, third{"pin", {{1, 2}}, Point(2, 0, 0)},
      wrong{"pin at the corner", {{1, 1}}, Point(1, 1e-6, 0)};
  EXPECT_TRUE(ConstraintSpace::create(3, std::vector{first, second, third}));
  const auto refused = ConstraintSpace::create(3, std::vector{first, second, wrong});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::input);
  EXPECT_EQ(refused.error().where, "pin at the corner");
  EXPECT_NE(refused.error().what.find("edge u0"), std::string::npos);
  EXPECT_NE(refused.error().what.find("seam"), std::string::npos);
}

TEST(ConstraintSpace, APlaneTakesOneFreedomFromAPoint) {
  const LinearConstraint plane{"plane", {{0, 1}}, Point(0, 0, 3), Point(0, 3, 4)};
  const auto space = ConstraintSpace::create(2, std::vector{plane});
  ASSERT_TRUE(space);
  EXPECT_TRUE(space->coupled());
  EXPECT_EQ(space->free_count(), 5);
  const Points member = space->feasible(random_points(2, 1));
  EXPECT_NEAR(0.6 * member(0, 1) + 0.8 * member(0, 2), 2.4, 1e-14);
}

TEST(ConstraintSpace, RefusesWhatIsNoConstraint) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(ConstraintSpace::create(2, std::vector{LinearConstraint{"a", {{2, 1}}}}));
  EXPECT_FALSE(ConstraintSpace::create(2, std::vector{LinearConstraint{"a", {{0, nan}}}}));
  EXPECT_FALSE(
      ConstraintSpace::create(2, std::vector{LinearConstraint{"a", {{0, 1}}, Point(nan, 0, 0)}}));
  EXPECT_FALSE(ConstraintSpace::create(
      2, std::vector{LinearConstraint{"a", {{0, 1}}, Point(0, 0, 0), Point(0, 0, 0)}}));
  EXPECT_FALSE(ConstraintSpace::create(2, std::vector{LinearConstraint{"a", {}, Point(1, 0, 0)}}));
  EXPECT_TRUE(ConstraintSpace::create(2, std::vector{LinearConstraint{"a", {}, Point(0, 0, 0)}}));
}

}  // namespace
}  // namespace knead
