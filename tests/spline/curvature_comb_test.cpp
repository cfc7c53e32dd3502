#include "spline/curvature_comb.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "knead/spline/curvature.hpp"
#include "knead/spline/revolution.hpp"

namespace knead {
namespace {

TEST(CurvatureCombs, OfATorusAreOneOverTheRadiiOfItsCircles) {
  const double big = 70, small = 30;
  const auto torus = revolve(*circle_quarters({big, 0}, small, 0, 4));
  ASSERT_TRUE(torus);
  const auto combs = curvature_combs(*torus, {.curves = {5, 5}, .teeth = 4});
  ASSERT_TRUE(combs);
  ASSERT_EQ(combs->size(), 10U);
  int meridians = 0;
  for (const CurvatureComb& comb : *combs) {
    bool meridian = true, parallel = true;
    for (Eigen::Index k = 0; k < comb.places.rows(); ++k) {
      const Point p = comb.places.row(k), c = comb.vectors.row(k);
      const double from_axis = std::hypot(p[0], p[1]);
      EXPECT_NEAR(std::hypot(from_axis - big, p[2]), small, 1e-10);
      meridian = meridian && std::abs(c.norm() * small - 1) < 1e-10;
      parallel = parallel && std::abs(c.norm() * from_axis - 1) < 1e-10;
    }
    EXPECT_TRUE(meridian || parallel);
    meridians += meridian ? 1 : 0;
  }
  EXPECT_EQ(meridians, 5);
}

TEST(CurvatureCombs, HaveTwoTeethWhereCurvatureJumps) {
  // A parabola and a straight line, tangent at u = 1/2: degree 2 along u, straight along v.
  const KnotVector u = *KnotVector::create(2, {0, 0, 0, 0.5, 1, 1, 1}),
                   v = *KnotVector::create(1, {0, 0, 1, 1});
  Points points(8, 3);
  const double x[4] = {0, 1, 3, 5}, z[4] = {1, 0, 0, 0};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 2; ++j) points.row(2 * i + j) << x[i], j, z[i];
  }
  const Surface surface = *Surface::create({u, v}, points);
  const auto combs = curvature_combs(surface, {.curves = {1, 0}, .teeth = 3});
  ASSERT_TRUE(combs);
  ASSERT_EQ(combs->size(), 1U);
  const CurvatureComb& comb = combs->front();
  ASSERT_EQ(comb.runs.size(), 8U);
  EXPECT_EQ(comb.runs[3], 0.5);
  EXPECT_EQ(comb.runs[4], 0.5);
  EXPECT_GT(comb.vectors.row(3).norm(), 0.1);
  EXPECT_NEAR(comb.vectors.row(4).norm(), 0, 1e-14);
  for (std::size_t k = 0; k < comb.runs.size(); ++k) {
    const Side side = k % 4 == 3 ? Side::left : Side::right;
    // The surface is a cylinder over the curve: its principal curvatures are that of the curve, and
    // 0.
    const auto expected = curvature(surface, {comb.runs[k], 0.5}, side);
    const double size =
        std::max(std::abs(expected->principal[0]), std::abs(expected->principal[1]));
    EXPECT_NEAR(comb.vectors.row(static_cast<Eigen::Index>(k)).norm(), size, 1e-12);
  }
}

TEST(CurvatureCombs, OfNoCurvesAreNoneAndWithoutPiecesAnError) {
  const auto torus = revolve(*circle_quarters({70, 0}, 30, 0, 4));
  EXPECT_TRUE(curvature_combs(*torus, {.curves = {0, 0}})->empty());
  EXPECT_FALSE(curvature_combs(*torus, {.teeth = 0}).has_value());
  EXPECT_FALSE(curvature_combs(*torus, {.curves = {-1, 3}}).has_value());
}

}  // namespace
}  // namespace knead
