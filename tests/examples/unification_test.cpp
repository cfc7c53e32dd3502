// What docs/unification.md says of the discrete models, checked.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "comparison.hpp"
#include "knead/gramian/gramian.hpp"
#include "mass_spring.hpp"

namespace knead::examples {
namespace {

TEST(Unification, DifferencesOfTheContourAreAChainOfSpringsToTheLastBit) {
  // Distances of powers of two make every entry a dyadic number: equal means equal.
  for (int n : {5, 16, 64}) {
    const double h = 1.0 / 64, alpha = 3, beta = 0.25;
    EXPECT_EQ(h * differenced_contour(n, alpha, beta, h),
              spring_ring(n, alpha / h, beta / (h * h * h)));
    EXPECT_EQ(differenced_contour(n, 5, 2, 1), spring_ring(n, 5, 2));  // thesis Eq. 3.47 has h = 1
  }
  const double h = 1.0 / 37;  // and any other distance to rounding
  const Eigen::MatrixXd a = h * differenced_contour(37, 0.3, 0.7, h),
                        b = spring_ring(37, 0.3 / h, 0.7 / (h * h * h));
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 16 * 1.2e-16 * b.cwiseAbs().maxCoeff());
}

TEST(Unification, AChainOfSpringsIsTheExactModelOfDegreeOne) {
  for (int n : {5, 33, 65}) {
    const auto knots = KnotVector::clamped_uniform(1, n);
    const auto g11 = gramian(*knots, 1, 1);
    ASSERT_TRUE(g11);
    EXPECT_EQ(g11->dense(), spring_chain(n, n - 1));
  }
}

TEST(Unification, ASheetOfSpringsIsTheExactModelOfDegreeOneWithLumpedMass) {
  // α (G11 ⊗ hI + hI ⊗ G11) on the masses inside.
  constexpr int n = 9, inner = n - 2;
  const double h = 1.0 / (n - 1);
  const Eigen::MatrixXd g =
      gramian(*KnotVector::clamped_uniform(1, n), 1, 1)->dense().block(1, 1, inner, inner);
  Eigen::MatrixXd lumped = Eigen::MatrixXd::Zero(inner * inner, inner * inner);
  for (int i = 0; i < inner; ++i) {
    for (int j = 0; j < inner; ++j) {
      for (int k = 0; k < inner; ++k) {
        lumped(i * inner + j, k * inner + j) += 3 * h * g(i, k);
        lumped(i * inner + j, i * inner + k) += 3 * h * g(j, k);
      }
    }
  }
  EXPECT_EQ(Eigen::MatrixXd(spring_sheet(n, 3, 0)), lumped);
}

TEST(Unification, HingedSpringsSwingAsTheirClosedFormSays) {
  constexpr int n = 12;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      Eigen::MatrixXd(spring_sheet(n, 1, 0.5)));
  const double l = 4 - 4 * std::cos(M_PI / (n - 1));
  EXPECT_NEAR(solver.eigenvalues()[0], l + 0.5 * l * l, 1e-13);
}

TEST(Unification, RelaxationFindsTheBalanceOfTheSprings) {
  const SparseMatrix k = spring_sheet(9, 1, 0.5);
  const Eigen::VectorXd f = Eigen::VectorXd::LinSpaced(k.rows(), -1, 2);
  const Relaxation found = relax(k, f, 0.1, 1e-10);
  const Eigen::VectorXd direct = Eigen::MatrixXd(k).ldlt().solve(f);
  EXPECT_LT((found.x - direct).norm(), 1e-7 * direct.norm());
  EXPECT_GT(found.steps, 10);
}

TEST(Unification, SpringsConvergeWithTheSquareOfTheirDistanceTheExactModelWithTheFourthPower) {
  const auto a = compare_models(17), b = compare_models(33);
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(std::log2(a->spring_error / b->spring_error), 2, 0.05);
  EXPECT_NEAR(std::log2(a->surface_error / b->surface_error), 2, 0.1);
  EXPECT_GT(std::log2(a->exact_error / b->exact_error), 3.8);
  EXPECT_LT(b->exact_error, 1e-3 * b->surface_error);
  // Twice as many masses in a row need four times the steps: bending is stiff.
  EXPECT_GT(b->relax_steps, 3 * a->relax_steps);
}

TEST(Unification, ASpringPerMassPullsHarderTheMoreMassesThereAre) {
  const auto a = touch(9, 0.01), b = touch(33, 0.01);
  ASSERT_TRUE(a && b);
  EXPECT_GT(b->springs, 8 * a->springs);  // sixteen times as many
  EXPECT_NEAR(b->exact / a->exact, 1, 1e-3);
}

TEST(Unification, InterpolatingAnewLosesDigitsAndASurfaceAtRestLosesNone) {
  EXPECT_GT(*interpolation_drift(0, 1000), 10 * *interpolation_drift(0, 1));
  EXPECT_EQ(*movement_at_rest(16), 0);
}

TEST(Unification, GlobalInterpolationRipplesWhereNothingWasTouched) {
  EXPECT_GT(*ripple(17, 0.05, true), 1e-3);
  EXPECT_LT(*ripple(65, 0.2, true), 1e-4);  // and dies out where knots suit the masses
  EXPECT_GT(*ripple(65, 0.2, false), 1);    // but not where they do not
}

}  // namespace
}  // namespace knead::examples
