#include "knead/spline/revolution.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <numbers>

#include "knead/spline/evaluate.hpp"
#include "support/numbers.hpp"

namespace knead {
namespace {

using testing::epsilon;

/// A grid of parameters over [0, 1]², knots among them.
Parameters<2> grid(int pieces) {
  Parameters<2> at((pieces + 1) * (pieces + 1), 2);
  for (int k = 0; k <= pieces; ++k) {
    for (int l = 0; l <= pieces; ++l)
      at.row(k * (pieces + 1) + l) << static_cast<double>(k) / pieces,
          static_cast<double>(l) / pieces;
  }
  return at;
}

TEST(Revolution, SphereIsExactToRounding) {
  for (const double r : {1e-3, 1.0, 2500.0}) {
    const auto sphere = revolve(*circle_quarters({0, 0}, r, -1, 2));
    ASSERT_TRUE(sphere);
    EXPECT_EQ(sphere->net(), (std::array<int, 2>{9, 5}));
    const auto jet = evaluate<2>(*sphere, grid(64), 1);
    ASSERT_TRUE(jet);
    EXPECT_LT((jet->points().rowwise().norm().array() / r - 1).abs().maxCoeff(), 8 * epsilon);
    // Outward, but where it vanishes: at the poles.
    for (Eigen::Index k = 0; k < jet->points().rows(); ++k) {
      const Point u = jet->at({1, 0}).row(k), v = jet->at({0, 1}).row(k), p = jet->points().row(k);
      if (k % 65 == 0 || k % 65 == 64) {
        EXPECT_LT(u.norm(), 8 * epsilon * r);
      } else {
        EXPECT_GT(u.cross(v).dot(p), 0) << k;
      }
    }
  }
}

TEST(Revolution, TorusIsExactToRounding) {
  const double major = 30, minor = 7;
  const auto torus = revolve(*circle_quarters({major, 0}, minor, 0, 4));
  ASSERT_TRUE(torus);
  const auto jet = evaluate<2>(*torus, grid(64), 1);
  ASSERT_TRUE(jet);
  for (Eigen::Index k = 0; k < jet->points().rows(); ++k) {
    const Point p = jet->points().row(k);
    const double out = std::hypot(p.x(), p.y());
    EXPECT_LT(std::abs(std::hypot(out - major, p.z()) - minor), 8 * epsilon * (major + minor));
    const Point normal = Point(jet->at({1, 0}).row(k)).cross(Point(jet->at({0, 1}).row(k)));
    EXPECT_GT(normal.dot(p - Point(p.x(), p.y(), 0) * (major / out)), 0);
  }
  // A turn ends where it began, to the bit.
  for (int j = 0; j < 9; ++j)
    EXPECT_EQ(torus->control_points().row(j), torus->control_points().row(8 * 9 + j));
}

TEST(Revolution, EveryPointGoesRoundAtTheRadiusAndHeightOfTheProfile) {
  Points points(6, 3);
  points << 3, 0, 0, 5, 0, 1, 2, 0, 2, 0.5, 0, 4, 1, 0, 6, 0, 0, 7;
  for (const bool rational : {false, true}) {
    const auto profile =
        Curve::create({*KnotVector::create(3, {-1, -1, -1, -1, 0, 1.5, 2, 2, 2, 2})}, points,
                      rational ? std::vector<double>{1, 2, 0.5, 1, 3, 1} : std::vector<double>{});
    ASSERT_TRUE(profile);
    const auto surface = revolve(*profile);
    ASSERT_TRUE(surface);
    for (const double v : {-1.0, -0.3, 0.0, 1.0, 1.9, 2.0}) {
      const Point on = *evaluate_point<1>(*profile, {v});
      for (int k = 0; k <= 40; ++k) {
        const Point p = *evaluate_point<2>(*surface, {k / 40.0, v});
        EXPECT_NEAR(std::hypot(p.x(), p.y()), on.x(), 16 * epsilon * 5);
        EXPECT_NEAR(p.z(), on.z(), 16 * epsilon * 7);
      }
    }
  }
}

TEST(Revolution, QuartersBeginWhereTheyAreAskedTo) {
  const auto arc = circle_quarters({2, 1}, 3, 1, 1);
  ASSERT_TRUE(arc);
  EXPECT_EQ(*evaluate_point<1>(*arc, {0.0}), Point(2, 0, 4));
  EXPECT_EQ(*evaluate_point<1>(*arc, {1.0}), Point(-1, 0, 1));
}

TEST(Revolution, RefusesAProfileOffThePlane) {
  Points points(2, 3);
  points << 1, 0, 0, 1, 0.1, 1;
  const auto made = revolve(*Curve::create({*KnotVector::clamped_uniform(1, 2)}, points));
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message().find("control point 1"), std::string::npos)
      << made.error().message();
}

}  // namespace
}  // namespace knead
