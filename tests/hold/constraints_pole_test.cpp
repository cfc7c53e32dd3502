#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "hold/constrained.hpp"

namespace knead {
namespace {

using namespace testing;

/// Cross derivatives at the pole v = lower or upper, along all meridians.
Points meridians(const Surface& s, bool upper) {
  const Interval v = s.knots(1).domain();
  return on_line(s, 1, upper ? v.upper : v.lower, 1, Side::right, 60);
}

/// Largest angle between the plane that all directions should lie in and any of them.
double out_of_plane(const Points& directions) {
  Point normal = Point::Zero();
  for (Eigen::Index k = 0; k + 1 < directions.rows(); ++k) {
    const Point n = Point(directions.row(k)).cross(Point(directions.row(k + 1)));
    if (n.norm() > normal.norm()) normal = n;
  }
  double angle = 0;
  for (Eigen::Index k = 0; k < directions.rows(); ++k) {
    angle = std::max(angle,
                     std::abs(normal.normalized().dot(directions.row(k).transpose().normalized())));
  }
  return angle;
}

/// A cone with its apex as pole v1.
Surface cone() {
  const Surface tube = cylinder();
  Points points = tube.control_points();
  for (int i = 0; i < 9; ++i) points.row(2 * i + 1) << 0, 0, 2;
  return *tube.with_control_points(points);
}

TEST(KeepPoles, SphereKeepsATangentPlaneAtItsPoles) {
  const Surface s = sphere();
  ConstraintList list(s.size());
  const auto poles = keep_poles(s, 1e-9, 1e-6, list);
  ASSERT_TRUE(poles);
  ASSERT_EQ(poles->size(), 2u);
  EXPECT_EQ((*poles)[0].edge, SurfaceEdge::v0);
  EXPECT_EQ((*poles)[1].edge, SurfaceEdge::v1);
  for (const Pole& pole : *poles) EXPECT_EQ(pole.rank, 2);
  EXPECT_EQ(space_of(s, list).free_count(), 45 - 2 * (8 + 7));
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Points x = random_member(s, list, seed);
    const Surface after = moved(s, 0.2 * x);
    for (const bool upper : {false, true}) {
      EXPECT_LT(out_of_plane(meridians(after, upper)), 1e-12);
      const double v = upper ? 2 : 0;
      const Points pole = on_line(after, 1, v, 0, Side::right);
      EXPECT_LT((pole.rowwise() - pole.row(0)).cwiseAbs().maxCoeff(), 1e-14);
      EXPECT_GT((pole.row(0) - on_line(s, 1, v, 0, Side::right).row(0)).norm(), 1e-4)
          << "the pole moves";
    }
  }
  EXPECT_GT(out_of_plane(meridians(moved(s, 0.2 * random_points(s.size(), 1)), true)),
            1e-2);  // the test can fail
}

TEST(KeepPoles, ComposeWithSmoothLines) {
  const Surface s = sphere();
  ConstraintList list(s.size());
  ASSERT_TRUE(keep_poles(s, 1e-9, 1e-6, list));
  ASSERT_TRUE(keep_smooth(s, {}, list));
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Surface after = moved(s, 0.2 * random_member(s, list, seed));
    for (const bool upper : {false, true}) EXPECT_LT(out_of_plane(meridians(after, upper)), 1e-11);
    for (const double u : {1.0, 2.0, 3.0}) EXPECT_LT(crease(after, 0, u), 1e-10);
    EXPECT_LT(crease(after, 1, 1), 1e-10);
  }
}

TEST(KeepPoles, ConeStaysAnAffineConeAtItsApex) {
  const Surface s = cone();
  ConstraintList list(s.size());
  const auto poles = keep_poles(s, 1e-9, 1e-6, list);
  ASSERT_TRUE(poles);
  ASSERT_EQ(poles->size(), 1u);
  EXPECT_EQ((*poles)[0].rank, 3);
  const Points rest = meridians(s, true);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Points now = meridians(moved(s, 0.2 * random_member(s, list, seed)), true);
    // One linear map takes all directions at rest to those now.
    const Eigen::Matrix3d map = (rest.transpose() * rest).ldlt().solve(rest.transpose() * now);
    EXPECT_LT((rest * map - now).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(KeepPoles, AnyWeightsAnyRing) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    for (const auto& [p, q] : {std::pair{2, 3}, {3, 1}, {1, 2}}) {
      // A disc: pole at u0, ring in a tilted plane, weights without any order.
      const KnotVector u = uniform_clamped(p, 3), v = uniform_clamped(q, 5);
      Points points = random_points(u.count() * v.count(), seed);
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < v.count(); ++j) {
          const double turn = 5.0 * j / v.count();
          points.row(i * v.count() + j) = Point(1, 2, 3) + i * (std::cos(turn) * Point(1, 0, 0.3) +
                                                                std::sin(turn) * Point(0, 2, -0.4));
        }
      }
      std::vector<double> weights;
      const Points w = random_points(points.rows(), seed + 100);
      for (Eigen::Index k = 0; k < w.rows(); ++k) weights.push_back(std::pow(100.0, w(k, 0)));
      const Surface s = make_surface(u, v, points, weights);
      ConstraintList list(s.size());
      const auto poles = keep_poles(s, 1e-9, 1e-6, list);
      ASSERT_TRUE(poles);
      ASSERT_EQ(poles->size(), 1u);
      EXPECT_EQ((*poles)[0].rank, 2);
      const Points directions =
          on_line(moved(s, 0.1 * random_member(s, list, seed)), 0, 0, 1, Side::right, 50);
      EXPECT_LT(out_of_plane(directions), 1e-10);
    }
  }
}

TEST(KeepPoles, TheToleranceDecidesWhatIsAPoint) {
  const Surface s = sphere();
  Points points = s.control_points();
  points(5, 0) += 1e-5;
  const Surface open = *s.with_control_points(points);
  ConstraintList list(s.size());
  EXPECT_EQ(keep_poles(open, 1e-6, 1e-6, list)->size(), 1u);
  ConstraintList wide(s.size());
  EXPECT_EQ(keep_poles(open, 1e-4, 1e-4, wide)->size(), 2u);
  ConstraintList none(s.size());
  EXPECT_TRUE(keep_poles(cylinder(), 1e-6, 1e-6, none)->empty());
}

}  // namespace
}  // namespace knead
