#include "knead/spline/evaluate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sample_splines.hpp"
#include "support/numbers.hpp"

namespace knead {
namespace {

using testing::epsilon;

TEST(MultiIndices, AreOrderedByTotalAndThenByDescendingFirstIndex) {
  using Index = MultiIndex<2>;
  EXPECT_EQ(multi_indices<2>(2),
            (std::vector<Index>{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}));
  EXPECT_EQ(multi_indices<1>(2), (std::vector<MultiIndex<1>>{{0}, {1}, {2}}));
  EXPECT_EQ(multi_indices<3>(1),
            (std::vector<MultiIndex<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
}

template <int D>
void expect_positions_match(int order) {
  const auto indices = multi_indices<D>(order);
  for (std::size_t k = 0; k < indices.size(); ++k) {
    EXPECT_EQ(multi_index_position<D>(indices[k]), static_cast<int>(k));
  }
}

TEST(MultiIndices, PositionIsThePlaceInTheList) {
  expect_positions_match<1>(16);
  expect_positions_match<2>(16);
  expect_positions_match<3>(9);
}

/// The control point of a polynomial's spline is its polar form at the knots; for x_1 x_2 … of
/// degree one in each factor, here for u^k: the mean of all products of k different ones of the p
/// knots.
double polar_power(const KnotVector& knots, int i, int k) {
  const int p = knots.degree();
  std::vector<double> elementary(static_cast<std::size_t>(k + 1), 0.0);
  elementary[0] = 1;
  for (int j = 1; j <= p; ++j) {
    for (int m = std::min(j, k); m >= 1; --m) {
      elementary[static_cast<std::size_t>(m)] +=
          knots[i + j] * elementary[static_cast<std::size_t>(m - 1)];
    }
  }
  double binomial = 1;
  for (int m = 1; m <= k; ++m) binomial = binomial * (p - k + m) / m;
  return elementary[static_cast<std::size_t>(k)] / binomial;
}

double power_derivative(double u, int k, int d) {
  double factor = 1;
  for (int m = 0; m < d; ++m) factor *= k - m;
  return d > k ? 0 : factor * std::pow(u, k - d);
}

/// x = Π u_d^{k_d}, a polynomial the spline reproduces, with all its partial derivatives.
template <int D>
void expect_monomial_reproduced(const std::array<KnotVector, D>& knots,
                                const std::array<int, D>& k) {
  int size = 1;
  for (const KnotVector& x : knots) size *= x.count();
  Points points(size, 3);
  for (int row = 0; row < size; ++row) {
    double value = 1;
    int rest = row;
    for (int d = D - 1; d >= 0; --d) {
      const auto& x = knots[static_cast<std::size_t>(d)];
      value *= polar_power(x, rest % x.count(), k[static_cast<std::size_t>(d)]);
      rest /= x.count();
    }
    points.row(row) << value, -value, 1;
  }
  const auto spline = testing::make_spline<D>(knots, points);
  const auto grid = testing::grid_of(spline);
  const Parameters<D> at = testing::rows_of<D>(grid);
  const int order = 3;
  const auto result = evaluate<D>(spline, at, order);
  ASSERT_TRUE(result) << result.error().message();
  for (const MultiIndex<D>& a : multi_indices<D>(order)) {
    for (Eigen::Index row = 0; row < at.rows(); ++row) {
      double exact = 1;
      int total = 0;
      for (int d = 0; d < D; ++d) {
        total += a[static_cast<std::size_t>(d)];
        exact *= power_derivative(at(row, d), k[static_cast<std::size_t>(d)],
                                  a[static_cast<std::size_t>(d)]);
      }
      // Knots are of size 1 to 4 with spans of 1/2 at least: each derivative multiplies rounding by
      // at most 2p · 2.
      const double scale = std::pow(4.0, 6) * std::pow(4.0 * knots[0].degree(), total);
      const auto value = result->at(a).row(row);
      ASSERT_NEAR(value(0), exact, 8 * epsilon * scale);
      ASSERT_EQ(value(1), -value(0));
      ASSERT_NEAR(value(2), total == 0 ? 1 : 0, 8 * epsilon * scale);
    }
  }
}

TEST(Evaluate, CurveReproducesPolynomialsUpToItsDegree) {
  for (int p = 1; p <= max_degree; ++p) {
    const auto clamped = testing::clamped_knots(p, {0, 1, 1.5, 2, 3}, {0, 1, std::min(2, p), 1, 0});
    const auto unclamped = testing::make_knots(p, [p] {
      std::vector<double> x;
      for (int i = 0; i < 2 * p + 4; ++i) x.push_back(1 + 0.125 * i);
      return x;
    }());
    for (int k = 0; k <= std::min(p, 5); ++k) expect_monomial_reproduced<1>({clamped}, {k});
    if (p <= 5) {
      for (int k = 0; k <= p; ++k) expect_monomial_reproduced<1>({unclamped}, {k});
    }
  }
}

TEST(Evaluate, SurfaceReproducesPolynomialsUpToItsDegrees) {
  const auto u = testing::clamped_knots(3, {0, 1, 2, 3}, {0, 1, 3, 0});
  const auto v = testing::clamped_knots(2, {-1, 0, 0.5, 1}, {0, 2, 1, 0});
  for (int k = 0; k <= 3; ++k) {
    for (int l = 0; l <= 2; ++l) expect_monomial_reproduced<2>({u, v}, {k, l});
  }
}

TEST(Evaluate, VolumeReproducesPolynomialsUpToItsDegrees) {
  const auto u = testing::clamped_knots(2, {0, 1, 2}), v = testing::clamped_knots(1, {0, 1, 1.5});
  const auto w = testing::clamped_knots(3, {-1, 0, 1});
  for (const std::array<int, 3> k : {std::array{0, 0, 0}, {2, 1, 3}, {1, 0, 2}, {0, 1, 1}}) {
    expect_monomial_reproduced<3>({u, v, w}, k);
  }
}

TEST(Evaluate, CornersOfAClampedNetAreInterpolatedExactly) {
  std::mt19937_64 random(1);
  const auto spline = testing::random_spline<2>(
      random, {testing::uniform_clamped(3, 2), testing::uniform_clamped(2, 3)});
  const auto [m, n] = spline.net();
  const auto& points = spline.control_points();
  EXPECT_EQ(*evaluate_point<2>(spline, {0, 0}), Point(points.row(0).transpose()));
  EXPECT_EQ(*evaluate_point<2>(spline, {0, 3}), Point(points.row(n - 1).transpose()));
  EXPECT_EQ(*evaluate_point<2>(spline, {2, 0}), Point(points.row((m - 1) * n).transpose()));
  EXPECT_EQ(*evaluate_point<2>(spline, {2, 3}), Point(points.row(m * n - 1).transpose()));
}

TEST(Evaluate, DerivativesAgreeWithDifferences) {
  std::mt19937_64 random(2);
  for (const double decades : {-1.0, 0.3}) {
    const auto spline = testing::random_spline<2>(
        random, {testing::uniform_clamped(4, 2), testing::uniform_clamped(3, 2)}, decades);
    const double u = 0.6, v = 1.3, h = 1e-4;
    const auto value = [&](double s, double t, int k) {
      Parameters<2> at(1, 2);
      at << s, t;
      return Point(
          evaluate<2>(spline, at, 2)->derivatives[static_cast<std::size_t>(k)].row(0).transpose());
    };
    const auto expect_near = [](const Point& a, const Point& b) {
      EXPECT_LT((a - b).norm(), 1e-5 * (1 + b.norm()));
    };
    // Positions: 0 is S, 1 S_u, 2 S_v, 3 S_uu, 4 S_uv, 5 S_vv.
    expect_near((value(u + h, v, 0) - value(u - h, v, 0)) / (2 * h), value(u, v, 1));
    expect_near((value(u, v + h, 0) - value(u, v - h, 0)) / (2 * h), value(u, v, 2));
    expect_near((value(u + h, v, 1) - value(u - h, v, 1)) / (2 * h), value(u, v, 3));
    expect_near((value(u, v + h, 1) - value(u, v - h, 1)) / (2 * h), value(u, v, 4));
    expect_near((value(u + h, v, 2) - value(u - h, v, 2)) / (2 * h), value(u, v, 4));
    expect_near((value(u, v + h, 2) - value(u, v - h, 2)) / (2 * h), value(u, v, 5));
  }
}

TEST(Evaluate, BothLimitsExistAtAKnotOfFullMultiplicity) {
  // Two separate parabolas: the curve jumps from (1, 0, 0) to (5, 0, 0).
  Points points(6, 3);
  points << 0, 0, 0, 0.5, 1, 0, 1, 0, 0, 5, 0, 0, 6, 2, 0, 7, 0, 0;
  const auto curve =
      testing::make_spline<1>({testing::make_knots(2, {0, 0, 0, 1, 1, 1, 2, 2, 2})}, points);
  const Parameters<1> at = Parameters<1>::Constant(1, 1, 1.0);
  EXPECT_EQ(evaluate<1>(curve, at, 0, Side::left)->points().row(0), points.row(2));
  EXPECT_EQ(evaluate<1>(curve, at, 0, Side::right)->points().row(0), points.row(3));
  EXPECT_EQ(evaluate<1>(curve, at, 1, Side::left)->at({1}).row(0),
            2 * (points.row(2) - points.row(1)));
  EXPECT_EQ(evaluate<1>(curve, at, 1, Side::right)->at({1}).row(0),
            2 * (points.row(4) - points.row(3)));
}

TEST(Evaluate, AffineMapsOfTheNetMapTheSurface) {
  std::mt19937_64 random(3);
  for (const double decades : {-1.0, 1.0}) {
    const auto spline = testing::random_spline<2>(
        random, {testing::uniform_clamped(3, 3), testing::clamped_knots(2, {0, 0.1, 2}, {0, 2, 0})},
        decades);
    Eigen::Matrix3d linear;
    linear << 1, 2, -1, 0.5, 3, 0, -2, 1, 1;
    const Eigen::RowVector3d shift(10, -20, 5);
    const auto mapped = spline.with_control_points(
        (spline.control_points() * linear.transpose()).rowwise() + shift);
    const Parameters<2> at = testing::rows_of<2>(testing::grid_of(spline));
    const auto before = evaluate<2>(spline, at, 1), after = evaluate<2>(*mapped, at, 1);
    const Points expected = (before->points() * linear.transpose()).rowwise() + shift;
    EXPECT_LT((after->points() - expected).cwiseAbs().maxCoeff(), 1e-13);
    for (const MultiIndex<2> a : {MultiIndex<2>{1, 0}, MultiIndex<2>{0, 1}}) {
      const double size = before->at(a).cwiseAbs().maxCoeff();
      EXPECT_LT((after->at(a) - before->at(a) * linear.transpose()).cwiseAbs().maxCoeff(),
                1e-12 * size * 20);
    }
  }
}

TEST(Evaluate, ParameterOutsideIsNamedByDirectionAndIndex) {
  std::mt19937_64 random(4);
  const auto spline = testing::random_spline<2>(
      random, {testing::uniform_clamped(2, 1), testing::uniform_clamped(2, 1)});
  Parameters<2> at(3, 2);
  at << 0, 0, 0.5, 1.5, 2, 2;
  EXPECT_EQ(evaluate<2>(spline, at).error().where, "direction 0: parameter 2");
  at(2, 0) = 1;
  EXPECT_EQ(evaluate<2>(spline, at).error().where, "direction 1: parameter 1");
  at(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(evaluate<2>(spline, at).error().where, "direction 1: parameter 1");
  EXPECT_FALSE(evaluate_point<2>(spline, {0.5, -1e-300}));
}

TEST(Evaluate, APointAloneHasTheBitsItHasAmongMany) {
  const auto compare = [](const auto& spline, auto parameters) {
    constexpr int D = decltype(parameters)::ColsAtCompileTime;
    const auto all = evaluate<D>(spline, parameters, 2);
    ASSERT_TRUE(all);
    for (Eigen::Index k = 0; k < parameters.rows(); k += 7) {
      const auto alone = evaluate<D>(spline, Parameters<D>(parameters.row(k)), 2);
      ASSERT_TRUE(alone);
      for (std::size_t d = 0; d < all->derivatives.size(); ++d) {
        EXPECT_EQ(alone->derivatives[d].row(0), all->derivatives[d].row(k));
      }
    }
  };
  const KnotVector knots = *KnotVector::clamped_uniform(3, 12);
  const auto net = [](int size) {
    Points points(size, 3);
    std::vector<double> weights;
    for (int i = 0; i < size; ++i) {
      points.row(i) << std::sin(i), std::cos(3 * i), std::sin(0.7 * i);
      weights.push_back(1 + 0.3 * std::sin(2 * i));
    }
    return std::pair(points, weights);
  };
  const auto [p, v] = net(12 * 12);
  Parameters<2> at(300, 2);
  for (int k = 0; k < 300; ++k) at.row(k) << k / 300., std::fmod(0.37 * k, 1);
  compare(*Surface::create({knots, knots}, p, v), at);
  const auto [q, w] = net(12);
  compare(*Curve::create({knots}, q, w), Parameters<1>(at.col(0)));
  const auto [r, x] = net(12 * 12 * 12);
  Parameters<3> in(300, 3);
  in << at, at.col(0);
  compare(*Volume::create({knots, knots, knots}, r, x), in);
}

TEST(Evaluate, NoParametersGiveNoPoints) {
  std::mt19937_64 random(5);
  const auto spline = testing::random_spline<1>(random, {testing::uniform_clamped(2, 1)});
  const auto result = evaluate<1>(spline, Parameters<1>(0, 1), 2);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->derivatives.size(), 3u);
  EXPECT_EQ(result->points().rows(), 0);
}

}  // namespace
}  // namespace knead
