#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "quad_reference.hpp"
#include "sample_splines.hpp"
#include "support/numbers.hpp"

namespace knead {
namespace {

using testing::Quad;

using testing::epsilon;

/// The full circle of radius r as a quadratic with nine control points (The NURBS Book,
/// Example 7.2).
Curve circle(double r) {
  Points points(9, 3);
  std::vector<double> weights;
  const int corners[9][2] = {{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                             {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
  for (int i = 0; i < 9; ++i) {
    points.row(i) << r * corners[i][0], r * corners[i][1], 0;
    weights.push_back(i % 2 == 0 ? 1 : 1 / std::numbers::sqrt2);
  }
  return testing::make_spline<1>({testing::make_knots(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4})},
                                 points, weights);
}

double binomial(int n, int k) {
  double value = 1;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

TEST(RationalCurve, CircleIsExactToRounding) {
  for (const double r : {1e-3, 1.0, 2500.0}) {
    const Curve curve = circle(r);
    Parameters<1> at(801, 1);
    for (int k = 0; k <= 800; ++k) at(k, 0) = k / 200.0;
    const auto result = evaluate<1>(curve, at);
    ASSERT_TRUE(result);
    const Eigen::ArrayXd radius = result->points().rowwise().norm();
    EXPECT_LT((radius / r - 1).abs().maxCoeff(), 4 * epsilon);
  }
}

TEST(RationalCurve, DerivativesOfACircleKeepItsRadius) {
  // C · C = r² for all u, so Σ_j binom(k, j) C^(j) · C^(k−j) = 0 for every order k >= 1, both sides
  // of every knot.
  const Curve curve = circle(1);
  Parameters<1> at(81, 1);
  for (int k = 0; k <= 80; ++k) at(k, 0) = k / 20.0;
  const int order = 8;
  for (const Side side : {Side::left, Side::right}) {
    const auto result = evaluate<1>(curve, at, order, side);
    ASSERT_TRUE(result);
    for (int row = 0; row < at.rows(); ++row) {
      for (int k = 1; k <= order; ++k) {
        double sum = 0, size = 0;
        for (int j = 0; j <= k; ++j) {
          const double term =
              binomial(k, j) * result->at({j}).row(row).dot(result->at({k - j}).row(row));
          sum += term;
          size += binomial(k, j) * result->at({j}).row(row).norm() *
                  result->at({k - j}).row(row).norm();
        }
        ASSERT_NEAR(sum, 0, 100 * epsilon * size) << "order " << k << " at " << at(row, 0);
      }
    }
  }
}

/// First derivatives and the mixed one of random surfaces whose weights range over 10^±decades,
/// against quadruple precision. With |x| <= 1 and W_a the sum of magnitudes that ∂^a w is made of,
/// the quotient rule's terms are at most 2 W_u / w, and 2 W_uv / w + 4 W_u W_v / w²: rounding
/// errors are relative to these.
void expect_exact_to_rounding(double decades, unsigned seed) {
  std::mt19937_64 random(seed);
  const auto surface = testing::random_spline<2>(
      random, {testing::uniform_clamped(3, 3), testing::clamped_knots(2, {0, 0.5, 2}, {0, 2, 0})},
      decades);
  const Parameters<2> at = testing::rows_of<2>(testing::grid_of(surface));
  const auto result = evaluate<2>(surface, at, 2);
  ASSERT_TRUE(result);
  for (int row = 0; row < at.rows(); ++row) {
    const testing::QuadReference<2> reference{surface, {at(row, 0), at(row, 1)}};
    const auto [h, size] = reference.homogeneous({0, 0});
    const auto [hu, size_u] = reference.homogeneous({1, 0});
    const auto [hv, size_v] = reference.homogeneous({0, 1});
    const auto [huv, size_uv] = reference.homogeneous({1, 1});
    const Quad w = h[3];
    for (std::size_t c = 0; c < 3; ++c) {
      const Quad s = h[c] / w, su = (hu[c] - hu[3] * s) / w, sv = (hv[c] - hv[3] * s) / w;
      const Quad suv = (huv[c] - hu[3] * sv - hv[3] * su - huv[3] * s) / w;
      const auto expect_near = [&](MultiIndex<2> a, Quad exact, Quad terms) {
        const Quad error =
            testing::magnitude(result->at(a)(row, static_cast<Eigen::Index>(c)) - exact);
        EXPECT_LE(static_cast<double>(error), 32 * epsilon * static_cast<double>(terms));
      };
      expect_near({0, 0}, s, 1);
      expect_near({1, 0}, su, 2 * size_u / w);
      expect_near({0, 1}, sv, 2 * size_v / w);
      expect_near({1, 1}, suv, 2 * size_uv / w + 4 * size_u / w * size_v / w);
    }
  }
}

TEST(RationalSurface, DerivativesAreExactToRounding) {
  for (unsigned seed = 0; seed < 20; ++seed) expect_exact_to_rounding(0, seed);
  for (unsigned seed = 0; seed < 20; ++seed) expect_exact_to_rounding(0.3, seed);
}

TEST(RationalSurface, WeightsMayRangeOverTwelveDecades) {
  for (unsigned seed = 0; seed < 20; ++seed) expect_exact_to_rounding(6, seed);
}

TEST(RationalSurface, PointsStayInTheBoxOfTheirControlPoints) {
  std::mt19937_64 random(21);
  const auto surface = testing::random_spline<2>(
      random, {testing::uniform_clamped(3, 3), testing::uniform_clamped(2, 3)}, 6);
  const auto result = evaluate<2>(surface, testing::rows_of<2>(testing::grid_of(surface)));
  ASSERT_TRUE(result);
  const Eigen::RowVector3d lower = surface.control_points().colwise().minCoeff();
  const Eigen::RowVector3d upper = surface.control_points().colwise().maxCoeff();
  EXPECT_TRUE(((result->points().rowwise() - lower).array() >= -8 * epsilon).all());
  EXPECT_TRUE(((result->points().rowwise() - upper).array() <= 8 * epsilon).all());
}

TEST(RationalSurface, EqualWeightsGiveThePolynomialSurface) {
  std::mt19937_64 random(22);
  const auto polynomial = testing::random_spline<2>(
      random, {testing::uniform_clamped(3, 3), testing::uniform_clamped(2, 3)});
  const auto rational = testing::make_spline<2>(
      polynomial.knots(), polynomial.control_points(),
      std::vector<double>(static_cast<std::size_t>(polynomial.size()), 0.7));
  const Parameters<2> at = testing::rows_of<2>(testing::grid_of(polynomial));
  const auto expected = evaluate<2>(polynomial, at, 2), got = evaluate<2>(rational, at, 2);
  for (std::size_t k = 0; k < expected->derivatives.size(); ++k) {
    EXPECT_LT((got->derivatives[k] - expected->derivatives[k]).cwiseAbs().maxCoeff(), 2e-13);
  }
}

TEST(RationalSurface, CommonFactorOfTheWeightsChangesNoBit) {
  std::mt19937_64 random(23);
  const auto surface = testing::random_spline<2>(
      random, {testing::uniform_clamped(3, 3), testing::uniform_clamped(2, 3)}, 1);
  std::vector<double> scaled(surface.weights().begin(), surface.weights().end());
  for (double& w : scaled) w = std::ldexp(w, -40);
  const auto other = testing::make_spline<2>(surface.knots(), surface.control_points(), scaled);
  const Parameters<2> at = testing::rows_of<2>(testing::grid_of(surface));
  const auto a = evaluate<2>(surface, at, 3), b = evaluate<2>(other, at, 3);
  for (std::size_t k = 0; k < a->derivatives.size(); ++k)
    EXPECT_EQ(a->derivatives[k], b->derivatives[k]);
}

TEST(RationalSurface, DenominatorThatIsNotPositiveIsNamed) {
  Points points = Points::Zero(4, 3);
  const auto knots = testing::make_knots(1, {0, 0, 1, 1});
  const auto surface = testing::make_spline<2>({knots, knots}, points, {1, 1, 1, -1});
  const std::array<std::vector<double>, 2> grid = {std::vector<double>{0, 1}, {0, 0.25, 0.5, 1}};
  const auto gridded = evaluate_grid<2>(surface, testing::spans_of<2>(grid), 1);
  ASSERT_FALSE(gridded);
  EXPECT_EQ(gridded.error().kind, ErrorKind::numerical);
  EXPECT_EQ(gridded.error().where, "parameter 1, 2");
  const auto scattered = evaluate<2>(surface, testing::rows_of<2>(grid), 1);
  ASSERT_FALSE(scattered);
  EXPECT_EQ(scattered.error().kind, ErrorKind::numerical);
  EXPECT_EQ(scattered.error().where, "parameter 6");
}

TEST(RationalSurface, NegativeWeightIsFineWhereTheDenominatorStaysPositive) {
  Points points(3, 3);
  points << 0, 0, 0, 1, 1, 0, 2, 0, 0;
  const auto curve =
      testing::make_spline<1>({testing::make_knots(2, {0, 0, 0, 1, 1, 1})}, points, {1, -0.5, 1});
  const auto middle = evaluate_point<1>(curve, {0.5});
  ASSERT_TRUE(middle);
  // (1/4 · P0 − 1/2 · 1/2 · P1 + 1/4 · P2) / (1/4 − 1/4 + 1/4) = (1, −1, 0).
  EXPECT_EQ(*middle, Point(1, -1, 0));
}

}  // namespace
}  // namespace knead
