#include "knead/energy/domain_scaling.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "support/surfaces.hpp"

namespace knead {
namespace {

TEST(DomainScaling, OfAFlatStripIsItsProportions) {
  const auto s = normalised_scaling<2>(testing::uniform_sheet(3, 9, 6, 20, 5));
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->length, 10, 1e-12);
  EXPECT_NEAR(s->factors[0], 2, 1e-13);
  EXPECT_NEAR(s->factors[1], 0.5, 1e-13);
}

TEST(DomainScaling, OfTheUnitSphereIsItsAreaAndMeanIsocurves) {
  // Area 4π. Parallels have the mean length 2π times the mean of the radius over v; meridians have
  // the length π.
  const auto s = normalised_scaling<2>(testing::sphere());
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->length * s->length, 4 * std::numbers::pi, 1e-5);
  EXPECT_NEAR(s->factors[1] * 2 * s->length, std::numbers::pi, 1e-5);
}

TEST(DomainScaling, IsInvariantUnderMotionAndProportionalToSize) {
  const Surface s =
      testing::relief(testing::uniform_clamped(3, 4), testing::uniform_clamped(2, 5), 3, 0.2, 3);
  const auto a = normalised_scaling<2>(s);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Point(1, 2, 3).normalized()).toRotationMatrix();
  const Points moved =
      (25.4 * s.control_points() * turn.transpose()).rowwise() + Eigen::RowVector3d(4, 5, 6);
  const auto b = normalised_scaling<2>(*s.with_control_points(moved));
  EXPECT_NEAR(b->length, 25.4 * a->length, 1e-13 * b->length);
  EXPECT_NEAR(b->factors[0], a->factors[0], 1e-13 * a->factors[0]);
  EXPECT_NEAR(b->factors[1], a->factors[1], 1e-13 * a->factors[1]);
}

TEST(DomainScaling, FollowsAffineMapsOfTheKnots) {
  const Surface s =
      testing::relief(testing::uniform_clamped(3, 4), testing::uniform_clamped(2, 5), 3);
  const auto map = [](const KnotVector& k, double scale, double shift) {
    std::vector<double> knots(k.knots().begin(), k.knots().end());
    for (double& x : knots) x = scale * x + shift;
    return *KnotVector::create(k.degree(), knots);
  };
  const auto a = normalised_scaling<2>(s);
  const auto b = normalised_scaling<2>(testing::make_surface(
      map(s.knots(0), 100, -3), map(s.knots(1), 0.01, 7), s.control_points()));
  EXPECT_NEAR(b->length, a->length, 1e-13 * a->length);
  EXPECT_NEAR(b->factors[0] * 100, a->factors[0], 1e-12 * a->factors[0]);
  EXPECT_NEAR(b->factors[1] * 0.01, a->factors[1], 1e-12 * a->factors[1]);
}

TEST(DomainScaling, RefusesASurfaceWithoutArea) {
  const Surface s = testing::uniform_sheet(2, 4, 4);
  Points line = s.control_points();
  line.col(1) = line.col(0);
  const auto refused = normalised_scaling<2>(*s.with_control_points(Points::Zero(16, 3)));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::numerical);
}

}  // namespace
}  // namespace knead
