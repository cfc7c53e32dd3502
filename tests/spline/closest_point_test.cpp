#include "knead/spline/closest_point.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "knead/spline/evaluate.hpp"
#include "knead/spline/revolution.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

std::vector<Point> random_points(int count, double reach, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> value(-reach, reach);
  std::vector<Point> points;
  for (int k = 0; k < count; ++k) points.emplace_back(value(random), value(random), value(random));
  return points;
}

/// What every result promises: the point is the spline at the parameters, and the distance is that
/// to it.
template <int D>
void expect_consistent(const Spline<D>& spline, const Point& x, const ClosestPoint<D>& found) {
  const auto there = evaluate_point<D>(spline, found.parameters);
  ASSERT_TRUE(there);
  const double size = spline.control_points().cwiseAbs().maxCoeff();
  EXPECT_LT((*there - found.point).norm(), 1e-13 * size);
  EXPECT_NEAR((x - found.point).norm(), found.distance, 1e-14 * (size + x.norm()));
}

TEST(ClosestPoint, OnASphereLiesOnTheRayFromItsCentre) {
  const auto sphere = revolve(*circle_quarters({0, 0}, 2, -1, 2));
  const auto search = ClosestPointSearch<2>::create(*sphere);
  ASSERT_TRUE(search);
  for (const Point& x : random_points(200, 4, 1)) {
    const auto found = search->nearest(x);
    EXPECT_TRUE(found.certified);
    EXPECT_NEAR(found.distance, std::abs(x.norm() - 2), 1e-13);
    EXPECT_LT((found.point - 2 * x.normalized()).norm(), 1e-11);
    expect_consistent(*sphere, x, found);
  }
}

TEST(ClosestPoint, OnATorusLiesOnTheRayFromTheMiddleOfItsTube) {
  const auto torus = revolve(*circle_quarters({3, 0}, 0.8, 0, 4));
  const auto search = ClosestPointSearch<2>::create(*torus);
  for (const Point& x : random_points(200, 4, 2)) {
    const auto found = search->nearest(x);
    EXPECT_TRUE(found.certified);
    EXPECT_NEAR(found.distance, std::abs(std::hypot(std::hypot(x.x(), x.y()) - 3, x.z()) - 0.8),
                1e-12);
  }
}

TEST(ClosestPoint, BeyondTheEndOfACylinderLiesOnItsRim) {
  const Surface cylinder = testing::cylinder(2);
  const auto found = closest_point(cylinder, Point(0, 3, 5));
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->certified);
  EXPECT_NEAR(found->distance, std::hypot(2, 3), 1e-13);
  EXPECT_NEAR(found->parameters[0], 1, 1e-8);
  EXPECT_EQ(found->parameters[1], 1);
}

TEST(ClosestPoint, AtAPoleIsThePoleWhateverTheParameterAlongIt) {
  const auto sphere = revolve(*circle_quarters({0, 0}, 1, -1, 2));
  const auto found = closest_point(*sphere, Point(0, 0, 3));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->distance, 2, 1e-14);
  EXPECT_LT((found->point - Point(0, 0, 1)).norm(), 1e-7);
}

TEST(ClosestPoint, IsNoFartherThanAnySampleOfTheSurface) {
  for (const double weights : {1.0, 5.0}) {
    const Surface s = testing::relief(*KnotVector::clamped_uniform(3, 7),
                                      *KnotVector::clamped_uniform(2, 6), 5, 0.5, weights);
    const auto search = ClosestPointSearch<2>::create(s);
    std::vector<double> grid;
    for (int k = 0; k <= 120; ++k) grid.push_back(k / 120.0);
    const Points samples = evaluate_grid<2>(s, {std::span<const double>(grid), grid})->points();
    for (const Point& x : random_points(60, 1.5, 6)) {
      const auto found = search->nearest(x);
      EXPECT_TRUE(found.certified);
      EXPECT_LE(found.distance,
                (samples.rowwise() - x.transpose()).rowwise().norm().minCoeff() + 1e-12);
      expect_consistent(s, x, found);
    }
  }
}

TEST(ClosestPoint, OnACircleLiesOnTheRayFromItsCentre) {
  const auto circle = circle_quarters({0, 0}, 2, 0, 4);  // in the plane of x and z
  const auto search = ClosestPointSearch<1>::create(*circle);
  for (const Point& x : random_points(200, 4, 3)) {
    const auto found = search->nearest(x);
    EXPECT_TRUE(found.certified);
    EXPECT_NEAR(found.distance, std::hypot(std::hypot(x.x(), x.z()) - 2, x.y()), 1e-13);
    expect_consistent(*circle, x, found);
  }
}

TEST(ClosestPoint, OfACurveIsItsEndWhereTheCurveLeadsAwayFromThePoint) {
  Points net(4, 3);
  net << 0, 0, 0, 1, 0, 0, 2, 0.5, 0, 3, 0, 0;
  const auto curve = Curve::create({*KnotVector::clamped_uniform(3, 4)}, net);
  const auto before = closest_point(*curve, Point(-2, 0, 1)),
             after = closest_point(*curve, Point(5, -1, 0));
  EXPECT_EQ(before->parameters[0], 0);
  EXPECT_EQ(after->parameters[0], 1);
  EXPECT_NEAR(before->distance, std::sqrt(5.0), 1e-15);
}

TEST(ClosestPoint, OfACurveIsNoFartherThanAnySample) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> value(-1, 1);
  Points net(12, 3);
  for (Eigen::Index i = 0; i < net.size(); ++i) net.data()[i] = value(random);
  const auto curve = Curve::create({*KnotVector::clamped_uniform(4, 12)}, net);
  const auto search = ClosestPointSearch<1>::create(*curve);
  Parameters<1> at = Eigen::VectorXd::LinSpaced(4000, 0, 1);
  const Points samples = evaluate<1>(*curve, at)->points();
  for (const Point& x : random_points(100, 1.2, 9)) {
    const auto found = search->nearest(x);
    EXPECT_TRUE(found.certified);
    EXPECT_LE(found.distance,
              (samples.rowwise() - x.transpose()).rowwise().norm().minCoeff() + 1e-13);
  }
}

TEST(ClosestPointFromAStart, FindsThePointItWasTakenFrom) {
  const Surface s = testing::relief(*KnotVector::clamped_uniform(3, 9),
                                    *KnotVector::clamped_uniform(3, 8), 3, 0.2, 3);
  const auto search = ClosestPointSearch<2>::create(s);
  for (const double u : {0.0, 0.21, 0.5, 1.0}) {
    for (const double v : {0.0, 0.4, 0.93}) {
      const Point x = *evaluate_point<2>(s, {u, v});
      const auto found =
          search->nearest_from(x, {std::min(u + 0.03, 1.0), std::max(v - 0.02, 0.0)});
      EXPECT_FALSE(found.certified);
      EXPECT_NEAR(found.parameters[0], u, 1e-11);
      EXPECT_NEAR(found.parameters[1], v, 1e-11);
      EXPECT_LT(found.distance, 1e-13);
    }
  }
}

TEST(ClosestPointFromAStart, PassesTheSeamOnlyWhereItMay) {
  const Surface cylinder = testing::cylinder(2);
  const auto search = ClosestPointSearch<2>::create(cylinder);
  // Just beyond the seam, u = 4.
  const Point x = 1.1 * Point(std::cos(0.2), std::sin(0.2), 0) + Point(0, 0, 1);
  const auto passed = search->nearest_from(x, {3.95, 0.5}, {true, false});
  EXPECT_NEAR(passed.distance, 0.1, 1e-13);
  EXPECT_LT(passed.parameters[0], 0.2);
  const auto stopped = search->nearest_from(x, {3.95, 0.5});
  EXPECT_EQ(stopped.parameters[0], 4);
  EXPECT_GT(stopped.distance, 0.2);
}

TEST(ClosestPoint, WhereWeightsAreNegativeIsFoundButNotCertified) {
  Points net(9, 3);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) net.row(3 * i + j) << i, j, (i == 1 && j == 1 ? 1 : 0);
  }
  const KnotVector k = *KnotVector::clamped_uniform(2, 3);
  const auto s = Surface::create({k, k}, net, {1, 1, 1, 1, -0.2, 1, 1, 1, 1});
  const auto found = closest_point(*s, *evaluate_point<2>(*s, {0.3, 0.7}));
  ASSERT_TRUE(found);
  EXPECT_LT(found->distance, 1e-10);
  EXPECT_FALSE(found->certified);
}

}  // namespace
}  // namespace knead
