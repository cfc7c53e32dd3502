#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "hold/constrained.hpp"

namespace knead {
namespace {

using namespace testing;

/// A relief whose rows at every edge are straight across it, moved and turned: edges lie in planes
/// that it is perpendicular to.
struct Half {
  Surface surface;
  Eigen::Matrix3d turn;

  Half(KnotVector u, KnotVector v, unsigned seed, double spread)
      : surface(relief(u, v, seed, 0.1, spread)) {
    const auto [m, n] = surface.net();
    Points points = surface.control_points();
    const Interval domain = u.domain();
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < m; ++i) {
        auto point = points.row(i * n + j);
        point[0] = 1.3 * (u.greville(i) - domain.lower) /
                   domain.length();  // S_x linear in u: u0 lies in x = 0
        if (i < u.degree())
          point.tail<2>() = points.row(j).tail<2>();  // and S_y, S_z do not change across it
      }
    }
    std::vector<double> weights(surface.weights().begin(), surface.weights().end());
    for (std::size_t k = static_cast<std::size_t>(n);
         k < weights.size() && k < static_cast<std::size_t>(u.degree() * n); ++k) {
      weights[k] = weights[k % static_cast<std::size_t>(n)];
    }
    turn = Eigen::AngleAxisd(0.7, Point(1, -2, 0.5).normalized()).toRotationMatrix();
    points = (points * turn.transpose()).rowwise() + Eigen::RowVector3d(3, 1, -2);
    surface = make_surface(u, v, points, weights);
  }
  [[nodiscard]] MirrorPlane plane() const { return {Point(3, 1, -2), 2 * turn.col(0)}; }
};

TEST(SymmetryPlane, EdgeStaysInItAndTheSurfacePerpendicular) {
  for (const double spread : {1.0, 5.0}) {
    for (const KnotVector& u : {uniform_clamped(2, 5), uniform_clamped(3, 4), uniform_clamped(4, 1),
                                uniform_unclamped(3, 4)}) {
      if (!u.clamped() && spread > 1) continue;
      const Half half(u, uniform_unclamped(2, 5), 3, spread);
      const Surface& s = half.surface;
      const Point n = half.plane().normal.normalized();
      ConstraintList list(s.size());
      const auto held = hold_symmetry_plane(s, SurfaceEdge::u0, half.plane(), 1, 1e-9, 1e-9, list);
      ASSERT_TRUE(held) << held.error().message();
      for (unsigned seed = 1; seed <= 10; ++seed) {
        const Surface after = moved(s, 0.2 * random_member(s, list, seed));
        const double c = u.domain().lower;
        const Points edge = on_line(after, 0, c, 0, Side::right),
                     across = on_line(after, 0, c, 1, Side::right);
        for (Eigen::Index k = 0; k < edge.rows(); ++k) {
          EXPECT_LT(std::abs(n.dot(edge.row(k).transpose() - half.plane().point)), 1e-12);
          EXPECT_LT(Point(across.row(k)).normalized().cross(n).norm(), 1e-11);
        }
        EXPECT_GT((edge - on_line(s, 0, c, 0, Side::right)).cwiseAbs().maxCoeff(), 1e-2)
            << "it moves in the plane";
      }
    }
  }
}

TEST(SymmetryPlane, SaysByHowMuchItIsMissed) {
  const Half half(uniform_clamped(3, 4), uniform_clamped(2, 4), 3, 5);
  ConstraintList list(half.surface.size());
  MirrorPlane off = half.plane();
  off.point += 0.25 * off.normal.normalized();
  auto held = hold_symmetry_plane(half.surface, SurfaceEdge::u0, off, 1, 1e-9, 1e-9, list);
  ASSERT_FALSE(held);
  EXPECT_NE(held.error().message().find("leaves the plane by 0.25"), std::string::npos)
      << held.error().message();
  const Surface tilted = relief(uniform_clamped(3, 4), uniform_clamped(2, 4), 3);
  Points points = tilted.control_points();
  points.topRows(tilted.net()[1]).col(0).setZero();
  held = hold_symmetry_plane(*tilted.with_control_points(points), SurfaceEdge::u0, {}, 1, 1e-9,
                             1e-3, list);
  ASSERT_FALSE(held);
  EXPECT_NE(held.error().message().find("right angles"), std::string::npos)
      << held.error().message();
  EXPECT_TRUE(hold_symmetry_plane(*tilted.with_control_points(points), SurfaceEdge::u0, {}, 0, 1e-9,
                                  1e-3, list));
  const std::size_t before = list.constraints.size();
  const Surface weighted = relief(uniform_clamped(3, 4), uniform_clamped(2, 4), 3, 0.1, 4);
  points = weighted.control_points();
  points.topRows(weighted.net()[1]).col(0).setZero();
  held = hold_symmetry_plane(*weighted.with_control_points(points), SurfaceEdge::u0, {}, 1, 1e-9,
                             1.5, list);
  ASSERT_FALSE(held);
  EXPECT_NE(held.error().message().find("proportional"), std::string::npos)
      << held.error().message();
  EXPECT_FALSE(hold_symmetry_plane(half.surface, SurfaceEdge::u0, {Point::Zero(), Point::Zero()}, 1,
                                   1, 1, list));
  EXPECT_EQ(list.constraints.size(), before);
}

/// S(u, v) with control points mirrored in x = 0 under i → m − 1 − i, then turned.
Surface symmetric(const KnotVector& u, const KnotVector& v, unsigned seed, double spread,
                  const Eigen::Matrix3d& turn) {
  const Surface s = relief(u, v, seed, 0.1, spread);
  const auto [m, n] = s.net();
  Points points = s.control_points();
  points.col(0).array() -= 0.65;
  std::vector<double> weights(s.weights().begin(), s.weights().end());
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * n + j, b = (m - 1 - i) * n + j;
      if (i > m - 1 - i) continue;
      points.row(b) = points.row(a);
      points(b, 0) = a == b ? 0 : -points(a, 0);
      if (!weights.empty())
        weights[static_cast<std::size_t>(b)] = weights[static_cast<std::size_t>(a)];
    }
  }
  return make_surface(u, v, points * turn.transpose(), weights);
}

TEST(KeepMirror, TheDisplacedSurfaceStaysSymmetric) {
  const Eigen::Matrix3d turns[2] = {
      Eigen::Matrix3d::Identity(),
      Eigen::AngleAxisd(0.9, Point(1, 1, 0.5).normalized()).toRotationMatrix()};
  for (const Eigen::Matrix3d& turn : turns) {
    for (const double spread : {1.0, 10.0}) {
      for (const KnotVector& u :
           {uniform_clamped(3, 5), uniform_clamped(2, 5), uniform_unclamped(3, 4),
            clamped_knots(3, {0, 1, 3, 4}, {4, 3, 3, 4})}) {
        const Surface s = symmetric(u, uniform_unclamped(2, 4), 5, spread, turn);
        const auto plane = mirror_plane(s, 0);
        ASSERT_TRUE(plane);
        EXPECT_LT(plane->normal.normalized().cross(turn.col(0)).norm(), 1e-9);
        ConstraintList list(s.size());
        const auto report = keep_mirror(s, 0, {Point::Zero(), turn.col(0)}, 1e-12, list);
        ASSERT_TRUE(report) << report.error().message();
        EXPECT_LT(report->shape, 1e-13);
        EXPECT_EQ(report->weights, 0);
        for (unsigned seed = 1; seed <= 5; ++seed) {
          const Points x = random_member(s, list, seed);
          const auto after =
              mirror_report(moved(s, 0.3 * x), 0, {Point::Zero(), turn.col(0)}, 1e-12);
          ASSERT_TRUE(after);
          EXPECT_LT(after->shape, 1e-12);
          EXPECT_GT(x.norm(), 1);
        }
      }
    }
  }
}

TEST(KeepMirror, LeavesHalfOfTheFreedom) {
  const Surface s =
      symmetric(uniform_clamped(3, 5), uniform_clamped(2, 4), 5, 1, Eigen::Matrix3d::Identity());
  ConstraintList list(s.size());
  ASSERT_TRUE(keep_mirror(s, 0, {}, 1e-12, list));
  EXPECT_EQ(space_of(s, list).free_count(), 3 * s.size() / 2);
}

TEST(KeepMirror, SaysHowFarSymmetryIsMissedAndWhichKnotsWouldDo) {
  const KnotVector u = clamped_knots(3, {0, 1, 2.5, 4}, {4, 1, 2, 4});
  const Surface s = relief(u, uniform_clamped(2, 3), 5);
  ConstraintList list(s.size());
  const auto kept = keep_mirror(s, 0, {Point(0.65, 0, 0), Point::UnitX()}, 1e-12, list);
  ASSERT_FALSE(kept);
  EXPECT_NE(kept.error().message().find("insert the knots 1.5, 1.5, 3"), std::string::npos)
      << kept.error().message();
  EXPECT_TRUE(list.constraints.empty());
  const auto report = mirror_report(s, 0, {Point(0.65, 0, 0), Point::UnitX()}, 1e-12);
  ASSERT_TRUE(report);
  EXPECT_NEAR(report->knots, 0.125, 1e-15);  // 3 is 0.5 from 2.5, 1.5 from 1
  EXPECT_EQ(report->insert, (std::vector<double>{1.5, 1.5, 3}));
  EXPECT_GT(report->shape, 0.01);

  const auto one_sided = mirror_report(
      relief(make_knots(2, {0, 0, 0, 1, 2, 3, 4, 5}), uniform_clamped(2, 3), 5), 0, {}, 1e-12);
  EXPECT_TRUE(one_sided->clamp);
  EXPECT_TRUE(one_sided->insert.empty());

  const Surface weighted = relief(uniform_clamped(3, 4), uniform_clamped(2, 3), 5, 0.1, 3);
  EXPECT_NE(
      keep_mirror(weighted, 0, {}, 1e-12, list).error().message().find("weights are not symmetric"),
      std::string::npos);
}

TEST(KeepMirror, InVIsTheSameWithDirectionsExchanged) {
  const Surface s =
      symmetric(uniform_clamped(3, 4), uniform_clamped(2, 3), 5, 4, Eigen::Matrix3d::Identity());
  const auto [m, n] = s.net();
  Points points(s.size(), 3);
  std::vector<double> weights(static_cast<std::size_t>(s.size()));
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      points.row(j * m + i) = s.control_points().row(i * n + j);
      weights[static_cast<std::size_t>(j * m + i)] =
          s.weights()[static_cast<std::size_t>(i * n + j)];
    }
  }
  const Surface turned = make_surface(s.knots(1), s.knots(0), points, weights);
  ConstraintList list(s.size());
  ASSERT_TRUE(keep_mirror(turned, 1, {}, 1e-12, list));
  EXPECT_LT(mirror_report(moved(turned, random_member(turned, list, 2)), 1, {}, 1e-12)->shape,
            1e-12);
}

}  // namespace
}  // namespace knead
