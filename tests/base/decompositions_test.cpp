#include "base/decompositions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace knead::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr double inf = std::numeric_limits<double>::infinity(),
                 nan = std::numeric_limits<double>::quiet_NaN();

MatrixXd random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  return MatrixXd::NullaryExpr(rows, columns, [&] { return number(random); });
}

Sparse sparse(const MatrixXd& a) { return a.sparseView(); }

TEST(Decompositions, EmptyMatricesHaveNoPivots) {
  for (const auto& [rows, columns] : {std::pair{0, 0}, std::pair{0, 3}, std::pair{3, 0}}) {
    const auto qr = PivotedQr::create(MatrixXd(rows, columns));
    ASSERT_TRUE(qr);
    EXPECT_EQ(qr->pivots(), 0);
    ASSERT_EQ(qr->order().size(), columns);
    for (int k = 0; k < columns; ++k) EXPECT_EQ(qr->order()[k], k);
    EXPECT_EQ(qr->remainder(0), MatrixXd::Zero(rows, columns));
    EXPECT_EQ(qr->coefficients(0), MatrixXd(0, columns));
    EXPECT_EQ(*least_squares(MatrixXd(rows, columns), VectorXd(VectorXd::Ones(rows))),
              VectorXd::Zero(columns));
  }
}

TEST(Decompositions, EmptySystemsHaveEmptySolutions) {
  EXPECT_EQ(left_singular(Eigen::Matrix3Xd(3, 0))->values, Eigen::Vector3d::Zero());
  EXPECT_EQ(left_singular(Eigen::Matrix3Xd(3, 0))->vectors, Eigen::Matrix3d::Identity());
  EXPECT_EQ(solve_square(MatrixXd(0, 0), MatrixXd(0, 2))->cols(), 2);
  EXPECT_EQ(symmetric_eigen(MatrixXd(0, 0))->values.size(), 0);
  EXPECT_EQ(DenseCholesky::factor(MatrixXd(0, 0))->solve(MatrixXd(0, 3)).cols(), 3);
  SparseLdlt ldlt;
  ASSERT_TRUE(ldlt.factor(Sparse(0, 0)));
  EXPECT_TRUE(ldlt.regular() && ldlt.positive());
  EXPECT_EQ(ldlt.solve(VectorXd(0)).size(), 0);
}

TEST(Decompositions, RankIsThatOfTheProduct) {
  for (const auto& [rows, columns, rank] :
       {std::tuple{6, 4, 0}, std::tuple{6, 4, 2}, std::tuple{3, 7, 1}, std::tuple{1, 1, 0},
        std::tuple{5, 5, 5}, std::tuple{1, 4, 1}}) {
    const MatrixXd a = random_matrix(rows, rank, 1) * random_matrix(rank, columns, 2);
    const auto qr = PivotedQr::create(a);
    ASSERT_TRUE(qr);
    for (int k = 0; k < qr->pivots(); ++k) EXPECT_EQ(qr->pivot(k) > 1e-13, k < rank);
    EXPECT_LE(qr->remainder(rank).norm(), 1e-13);
    if (rank == 0) continue;
    MatrixXd chosen(rows, rank);
    for (int k = 0; k < rank; ++k) chosen.col(k) = a.col(qr->order()[k]);
    EXPECT_LE((chosen * qr->coefficients(rank) - a).norm(), 1e-12);
  }
}

TEST(Decompositions, LeastSquaresOfDependentColumnsReachTheSpan) {
  const MatrixXd a = random_matrix(6, 2, 3) * random_matrix(2, 4, 4);
  const VectorXd x = *least_squares(a, VectorXd(a * VectorXd::Ones(4)));
  EXPECT_LE((a * x - a * VectorXd::Ones(4)).norm(), 1e-13);
}

TEST(Decompositions, NumbersThatAreNotFiniteAreNamed) {
  for (const double wrong : {inf, -inf, nan}) {
    MatrixXd a = MatrixXd::Identity(3, 3);
    a(2, 1) = wrong;
    const auto refused = PivotedQr::create(a);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::numerical);
    EXPECT_EQ(refused.error().where, "(2, 1)");
    EXPECT_FALSE(left_singular(a));
    EXPECT_FALSE(least_squares(a, VectorXd(VectorXd::Ones(3))));
    EXPECT_FALSE(
        least_squares(MatrixXd(MatrixXd::Identity(3, 3)), VectorXd(VectorXd::Constant(3, wrong))));
    EXPECT_FALSE(solve_square(a, MatrixXd::Ones(3, 1)));
    EXPECT_FALSE(solve_square(MatrixXd::Identity(3, 3), MatrixXd::Constant(3, 1, wrong)));
    EXPECT_FALSE(rank_of(a));
    EXPECT_FALSE(symmetric_eigen(a));
    EXPECT_FALSE(symmetric_eigen(Eigen::Matrix3d(a)));
    EXPECT_FALSE(symmetric_eigenvalues(a));
    EXPECT_FALSE(DenseCholesky::factor(a));
    SparseLdlt ldlt;
    EXPECT_FALSE(ldlt.factor(sparse(a)));
  }
}

TEST(Decompositions, SingularSystemsAreRefused) {
  EXPECT_FALSE(solve_square(MatrixXd::Zero(2, 2), MatrixXd::Ones(2, 1)));
  EXPECT_FALSE(solve_square(MatrixXd::Ones(3, 3), MatrixXd::Identity(3, 3)));
  EXPECT_FALSE(DenseCholesky::factor(-MatrixXd::Identity(2, 2)));
  SparseLdlt ldlt;
  EXPECT_FALSE(ldlt.factor(Sparse(2, 2)));
  MatrixXd nearly = MatrixXd::Identity(2, 2);
  nearly(1, 1) = 1e-16;
  ASSERT_TRUE(ldlt.factor(sparse(nearly)));
  EXPECT_FALSE(ldlt.regular());
  nearly(1, 1) = -1;
  ASSERT_TRUE(ldlt.factor(sparse(nearly)));
  EXPECT_TRUE(ldlt.regular());
  EXPECT_FALSE(ldlt.positive());
}

/// Squares of their entries overflow or vanish.
TEST(Decompositions, ExtremeNumbersAreDecomposedLikeOthers) {
  const MatrixXd a = random_matrix(3, 5, 5);
  const auto qr = PivotedQr::create(a);
  const VectorXd x = *least_squares(a, VectorXd(VectorXd::Ones(3)));
  const auto singular = left_singular(a);
  for (const int exponent : {600, -600}) {
    const double factor = std::ldexp(1, exponent);
    const auto large = PivotedQr::create(factor * a);
    ASSERT_TRUE(large);
    EXPECT_EQ(large->order(), qr->order());
    for (int k = 0; k < 3; ++k) EXPECT_DOUBLE_EQ(large->pivot(k), factor * qr->pivot(k));
    EXPECT_LE((large->remainder(1) / factor - qr->remainder(1)).norm(), 1e-15);
    EXPECT_LE((large->coefficients(3) - qr->coefficients(3)).norm(), 1e-15);
    EXPECT_LE((factor * *least_squares(factor * a, VectorXd(VectorXd::Ones(3))) - x).norm(), 1e-15);
    EXPECT_LE((left_singular(factor * a)->values / factor - singular->values).norm(), 1e-15);
    EXPECT_EQ(*rank_of(factor * Eigen::Matrix3d::Identity()), 3);
  }
}

TEST(Decompositions, EigenvaluesIncreaseAndRecomposeTheMatrix) {
  const MatrixXd half = random_matrix(4, 4, 6), a = half + half.transpose();
  const auto eigen = symmetric_eigen(a);
  ASSERT_TRUE(eigen);
  for (int k = 1; k < 4; ++k) EXPECT_LE(eigen->values[k - 1], eigen->values[k]);
  EXPECT_LE((eigen->vectors * eigen->values.asDiagonal() * eigen->vectors.transpose() - a).norm(),
            1e-14);
}

TEST(Decompositions, LaterMatricesOfASparseFactorMayHaveAnotherPattern) {
  SparseLdlt ldlt;
  MatrixXd a = 4 * MatrixXd::Identity(5, 5);
  const VectorXd b = VectorXd::LinSpaced(5, 1, 5);
  for (const auto& [i, j] : {std::pair{0, 0}, std::pair{4, 1}, std::pair{3, 0}}) {
    a(i, j) = a(j, i) = i == j ? 4 : 1;
    ASSERT_TRUE(ldlt.factor(sparse(a)));
    EXPECT_TRUE(ldlt.positive());
    EXPECT_LE((a * ldlt.solve(b) - b).norm(), 1e-14);
  }
  ASSERT_TRUE(ldlt.factor(sparse(MatrixXd(2 * MatrixXd::Identity(2, 2)))));
  EXPECT_EQ(ldlt.solve(VectorXd(VectorXd::Ones(2))), VectorXd::Constant(2, 0.5));
}

}  // namespace
}  // namespace knead::detail
