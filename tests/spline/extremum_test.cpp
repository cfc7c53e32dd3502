#include "knead/spline/extremum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sample_splines.hpp"

namespace knead {
namespace {

/// Degree 3 × 3 over [0, 1]² with z = f(u) g(v) from Bernstein coefficients, x = u, y = v.
Surface bump(const std::array<double, 4>& f, const std::array<double, 4>& g, double height = 1) {
  Points points(16, 3);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      points.row(4 * i + j) << i / 3.0, j / 3.0,
          height * f[static_cast<std::size_t>(i)] * g[static_cast<std::size_t>(j)];
    }
  }
  const auto knots = testing::clamped_knots(3, {0, 1});
  return testing::make_spline<2>({knots, knots}, points);
}

/// The lateral surface of a full cylinder of radius r around the z axis, between z = 0 and z =
/// height.
Surface cylinder(double r, double height) {
  const int corners[9][2] = {{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                             {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
  const double angle = 0.3;  // turned, so that no extremum lies at a knot
  Points points(18, 3);
  std::vector<double> weights;
  for (int i = 0; i < 9; ++i) {
    const double x = r * corners[i][0], y = r * corners[i][1];
    for (int j = 0; j < 2; ++j) {
      points.row(2 * i + j) << std::cos(angle) * x - std::sin(angle) * y,
          std::sin(angle) * x + std::cos(angle) * y, j * height;
      weights.push_back(i % 2 == 0 ? 1 : 1 / std::numbers::sqrt2);
    }
  }
  return testing::make_spline<2>({testing::make_knots(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}),
                                  testing::clamped_knots(1, {0, 1})},
                                 points, weights);
}

void expect_near(const Point& a, const Point& b, double tolerance) {
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), tolerance)
      << a.transpose() << " is not " << b.transpose();
}

TEST(BoundingBox, OfACylinderTouchesItAndNotItsControlPoints) {
  const auto box = bounding_box(cylinder(2, 5));
  expect_near(box.lower, {-2, -2, 0}, 1e-9 * 8);
  expect_near(box.upper, {2, 2, 5}, 1e-9 * 8);
  EXPECT_NEAR(box.diagonal(), std::sqrt(16 + 16 + 25), 1e-8);
  expect_near(box.centre(), {0, 0, 2.5}, 1e-8);
}

TEST(BoundingBox, OfAFlatPatchIsFlatAndHasNoNegativeZero) {
  const auto box = bounding_box(bump({0, 0, 0, 0}, {1, 1, 1, 1}));
  EXPECT_EQ(box.lower, Point(0, 0, 0));
  expect_near(box.upper, {1, 1, 0}, 1e-15);
  EXPECT_EQ(box.upper.z(), 0);
  EXPECT_FALSE(std::signbit(box.lower.x()) || std::signbit(box.lower.z()));
}

TEST(BoundingBox, FindsTheTopOfABumpBetweenTheSamples) {
  // 3 u²(1 − u) is largest at u = 2/3, where it is 4/9; 3 v(1 − v)² at v = 1/3.
  const auto box = bounding_box(bump({0, 0, 1, 0}, {0, 1, 0, 0}, 7));
  EXPECT_NEAR(box.upper.z(), 7 * 16.0 / 81, 1e-9);
  EXPECT_EQ(box.lower.z(), 0);
}

TEST(BoundingBox, HoldsEveryPointAndIsHeldByTheControlPoints) {
  std::mt19937_64 random(31);
  for (int p = 1; p <= 5; ++p) {
    for (const double decades : {-1.0, 0.5}) {
      const auto surface = testing::random_spline<2>(
          random, {testing::random_knots(random, p), testing::uniform_clamped(6 - p, 3)}, decades);
      const auto box = bounding_box(surface);
      std::array<std::vector<double>, 2> grid;
      for (std::size_t d = 0; d < 2; ++d) {
        const KnotVector& knots = surface.knots()[d];
        for (const int s : knots.spans()) {
          for (int k = 0; k <= 20; ++k)
            grid[d].push_back(std::lerp(knots[s], knots[s + 1], k / 20.0));
        }
      }
      const auto points = evaluate_grid<2>(surface, testing::spans_of<2>(grid));
      const double slack = 1e-9 * box.diagonal();
      for (int c = 0; c < 3; ++c) {
        EXPECT_LE(box.lower[c], points->points().col(c).minCoeff() + slack);
        EXPECT_GE(box.upper[c], points->points().col(c).maxCoeff() - slack);
        EXPECT_GE(box.lower[c], surface.control_points().col(c).minCoeff() - slack);
        EXPECT_LE(box.upper[c], surface.control_points().col(c).maxCoeff() + slack);
      }
    }
  }
}

TEST(BoundingBox, SeesBothLimitsWhereASurfaceJumps) {
  // In u two separate pieces of degree 1: z rises from 0 to 3, then jumps down to −2 and rises
  // to 1.
  Points points(8, 3);
  const double z[4] = {0, 3, -2, 1};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 2; ++j) points.row(2 * i + j) << i, j, z[i];
  }
  const auto surface = testing::make_spline<2>(
      {testing::make_knots(1, {0, 0, 1, 1, 2, 2}), testing::clamped_knots(1, {0, 1})}, points);
  const auto box = bounding_box(surface);
  EXPECT_EQ(box.lower.z(), -2);
  EXPECT_EQ(box.upper.z(), 3);
}

TEST(LargestNorm, OfZeroIsZero) {
  const auto surface = bump({0, 0, 0, 0}, {0, 0, 0, 0});
  const auto zero = surface.with_control_points(Points::Zero(16, 3));
  EXPECT_EQ(largest_norm(*zero).value, 0);
}

TEST(LargestNorm, IsFoundWithItsParameters) {
  Points points = bump({0, 0, 1, 0}, {0, 1, 0, 0}, -7).control_points();
  points.leftCols<2>().setZero();
  const auto displacement = bump({0, 0, 1, 0}, {0, 1, 0, 0}).with_control_points(points);
  const auto largest = largest_norm(*displacement);
  EXPECT_NEAR(largest.value, 7 * 16.0 / 81, 1e-9 * 7);
  EXPECT_NEAR(largest.parameters[0], 2.0 / 3, 1e-5);
  EXPECT_NEAR(largest.parameters[1], 1.0 / 3, 1e-5);
}

TEST(LargestNorm, DoesNotDependOnUnits) {
  Points points = bump({0, 0, 1, 0}, {0, 1, 0, 0}).control_points();
  points.leftCols<2>().setZero();
  const auto unit = bump({0, 0, 1, 0}, {0, 1, 0, 0}).with_control_points(points);
  for (const int exponent : {-1000, -500, -300, -40, 40, 150, 165}) {
    const auto scaled = unit->with_control_points(points * std::ldexp(1.0, exponent));
    EXPECT_NEAR(std::ldexp(largest_norm(*scaled).value, -exponent), largest_norm(*unit).value,
                1e-9);
  }
}

TEST(LargestNorm, IsAtLeastThatOfEveryPoint) {
  std::mt19937_64 random(32);
  for (int p = 1; p <= 5; ++p) {
    const auto surface = testing::random_spline<2>(
        random, {testing::uniform_clamped(p, 4), testing::uniform_clamped(6 - p, 5)});
    std::array<std::vector<double>, 2> grid;
    for (std::size_t d = 0; d < 2; ++d) {
      for (int k = 0; k <= 200; ++k) grid[d].push_back(surface.knots()[d].domain().upper * k / 200);
    }
    const auto points = evaluate_grid<2>(surface, testing::spans_of<2>(grid));
    const double largest = points->points().rowwise().norm().maxCoeff();
    EXPECT_GE(largest_norm(surface).value, largest * (1 - 1e-9));
    EXPECT_LE(largest_norm(surface).value,
              surface.control_points().rowwise().norm().maxCoeff() * (1 + 1e-9));
  }
}

}  // namespace
}  // namespace knead
