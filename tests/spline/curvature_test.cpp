#include "knead/spline/curvature.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "knead/spline/revolution.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

/// Parameters inside of the domain [0, 1]², knots among them.
const std::array<double, 6> inside = {0.03, 0.25, 0.4, 0.5, 0.77, 0.96};

TEST(SurfaceCurvature, OfASphereIsOneOverItsRadiusInEveryDirection) {
  for (const double r : {1e-3, 1.0, 2500.0}) {
    const auto sphere = revolve(*circle_quarters({0, 0}, r, -1, 2));  // normals point outwards
    for (const double u : inside) {
      for (const double v : inside) {
        const auto k = curvature(*sphere, {u, v});
        ASSERT_TRUE(k);
        EXPECT_NEAR(k->mean * r, -1, 1e-11);
        EXPECT_NEAR(k->gaussian * r * r, 1, 1e-11);
        EXPECT_NEAR(k->principal[0] * r, -1, 1e-11);
        EXPECT_NEAR(k->principal[1] * r, -1, 1e-11);
        EXPECT_NEAR(k->directions[0].norm(), 1, 1e-14);
        EXPECT_NEAR(k->directions[0].dot(k->normal), 0, 1e-14);
      }
    }
  }
}

TEST(SurfaceCurvature, OfATorusIsThatOfItsCirclesAtEveryPoint) {
  const double big = 3, small = 0.8;
  const auto torus = revolve(*circle_quarters({big, 0}, small, 0, 4));
  for (const double u : inside) {
    for (const double v : inside) {
      const auto k = curvature(*torus, {u, v});
      ASSERT_TRUE(k);
      const Point p = *evaluate_point<2>(*torus, {u, v});
      const double rho = std::hypot(p.x(), p.y()), across = 1 / small,
                   along = (rho - big) / small / rho;
      const Point out = (p - big / rho * Point(p.x(), p.y(), 0)) / small;
      const double side = k->normal.dot(out) > 0 ? -1 : 1;
      EXPECT_NEAR(k->normal.cross(out).norm(), 0, 1e-12);
      EXPECT_NEAR(k->principal[0], std::max(side * across, side * along), 1e-11);
      EXPECT_NEAR(k->principal[1], std::min(side * across, side * along), 1e-11);
      EXPECT_NEAR(k->gaussian, across * along, 1e-11);
      EXPECT_NEAR(k->mean, side * (across + along) / 2, 1e-11);
      // The direction of the parallel's curvature goes round the axis.
      const Point round = Point(-p.y(), p.x(), 0) / rho;
      const auto parallel = side > 0 ? 1U : 0U;
      EXPECT_NEAR(std::abs(k->directions[parallel].dot(round)), 1, 1e-12);
    }
  }
}

TEST(SurfaceCurvature, OfACylinderVanishesAlongItsAxis) {
  const Surface cylinder = testing::cylinder();
  for (const double u : {0.1, 1.0, 2.7, 4.0}) {
    const auto k = curvature(cylinder, {u, 0.3});
    ASSERT_TRUE(k);
    const auto straight = std::abs(k->principal[0]) < std::abs(k->principal[1]) ? 0U : 1U;
    EXPECT_NEAR(k->principal[straight], 0, 1e-14);
    EXPECT_NEAR(std::abs(k->principal[1 - straight]), 1, 1e-12);
    EXPECT_NEAR(k->gaussian, 0, 1e-14);
    EXPECT_NEAR(std::abs(k->directions[straight].z()), 1, 1e-14);
  }
}

TEST(SurfaceCurvature, FormsAndFrameAgreeOnAnyRationalSurface) {
  const KnotVector u = *KnotVector::clamped_uniform(3, 8), v = *KnotVector::clamped_uniform(2, 7);
  const Surface s = testing::relief(u, v, 11, 0.3, 3);
  for (const double a : inside) {
    for (const double b : inside) {
      const auto k = curvature(s, {a, b});
      ASSERT_TRUE(k);
      Parameters<2> at(1, 2);
      at << a, b;
      const auto jet = evaluate<2>(s, at, 2);
      const auto d = [&](int i, int j) { return Point(jet->at({i, j}).row(0).transpose()); };
      const FundamentalForms forms(d(1, 0), d(0, 1), d(2, 0), d(1, 1), d(0, 2), k->normal);
      const double scale = std::max(std::abs(k->principal[0]), std::abs(k->principal[1]));
      EXPECT_NEAR(forms.mean(), k->mean, 1e-12 * scale);
      EXPECT_NEAR(forms.gaussian(), k->gaussian, 1e-12 * scale * scale);
      EXPECT_NEAR(k->principal[0] * k->principal[1], k->gaussian, 1e-12 * scale * scale);
      EXPECT_NEAR((k->directions[0].cross(k->directions[1]) - k->normal).norm(), 0, 1e-12);
    }
  }
}

TEST(SurfaceCurvature, AtAPoleIsAnErrorThatNamesTheParameters) {
  const auto sphere = revolve(*circle_quarters({0, 0}, 1, -1, 2));
  const auto k = curvature(*sphere, {0.3, 1});
  ASSERT_FALSE(k);
  EXPECT_EQ(k.error().kind, ErrorKind::numerical);
  EXPECT_EQ(k.error().where, "(0.3, 1)");
  EXPECT_FALSE(curvature(*sphere, {0.3, 1.5}));
}

TEST(CurveCurvature, OfACircleIsOneOverItsRadiusTowardsItsCentre) {
  for (const double r : {1e-3, 1.0, 2500.0}) {
    const auto circle = circle_quarters({0, 0}, r, 0, 4);
    for (const double t : inside) {
      const auto k = curvature(*circle, t);
      ASSERT_TRUE(k);
      EXPECT_NEAR(k->curvature * r, 1, 1e-12);
      EXPECT_NEAR((*evaluate_point<1>(*circle, {t}) / r + k->normal).norm(), 0, 1e-12);
      EXPECT_NEAR(k->tangent.dot(k->normal), 0, 1e-13);
    }
  }
}

TEST(CurveCurvature, OfAStraightLineIsZeroAndOfAPointAnError) {
  Points line(3, 3);
  line << 0, 0, 0, 1, 0, 0, 2, 0, 0;
  const KnotVector k = *KnotVector::clamped_uniform(2, 3);
  const auto straight = curvature(*Curve::create({k}, line), 0.4);
  ASSERT_TRUE(straight);
  EXPECT_EQ(straight->curvature, 0);
  EXPECT_EQ(straight->normal.norm(), 0);
  EXPECT_FALSE(curvature(*Curve::create({k}, Points::Zero(3, 3)), 0.4));
}

}  // namespace
}  // namespace knead
