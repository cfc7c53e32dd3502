#include <gtest/gtest.h>

#include "hold/constrained.hpp"
#include "knead/contact/active_spline.hpp"
#include "support/tools.hpp"

/// The constraints at work: sculpted with tools, they hold on the surface that comes out.
namespace knead {
namespace {

using namespace testing;

Tool ball(const Point& centre, double radius) {
  return {"ball", testing::sphere_at(centre, radius), ToolMode::collision, 1e3};
}

ActiveSurface active(const Surface& s, const ConstraintList& list) {
  ActiveSettings<2> settings;
  settings.held = list.held;
  settings.constraints = list.constraints;
  settings.detail = 0.1;
  settings.lambda = 5;
  auto made = ActiveSurface::create(s, settings);
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

Surface sculpted(const Surface& s, const ConstraintList& list, const std::vector<Tool>& tools,
                 int steps = 6) {
  const ActiveSurface model = active(s, list);
  EXPECT_EQ(model.step(s.control_points(), {})->control_points, s.control_points())
      << "at rest nothing moves";
  Points x = s.control_points();
  for (int k = 0; k < steps; ++k) {
    auto step = model.step(x, tools);
    if (!step) {
      ADD_FAILURE() << step.error().message();
      break;
    }
    EXPECT_LT(step->violation, 1e-10 * size_of(s));
    x = step->control_points;
  }
  EXPECT_GT((x - s.control_points()).cwiseAbs().maxCoeff(), 0.02) << "the tools do something";
  return *s.with_control_points(x);
}

TEST(SculptedUnderConstraints, CylinderShowsNoCreaseUnlessItMay) {
  const Surface s = cylinder();
  const std::vector<Tool> tools = {ball(Point(1.2, 0.3, 1), 0.45)};
  ConstraintList list(s.size());
  const Surface free = sculpted(s, list, tools);
  ASSERT_TRUE(keep_smooth(s, {}, list));
  const Surface smooth = sculpted(s, list, tools);
  double without = 0;
  for (const double u : {1.0, 2.0, 3.0}) {
    without = std::max(without, crease(free, 0, u));
    EXPECT_LT(crease(smooth, 0, u), 1e-9);
  }
  EXPECT_GT(without, 1e-3);
}

TEST(SculptedUnderConstraints, SphereKeepsPolesAndSmoothness) {
  const Surface s = sphere();
  ConstraintList list(s.size());
  ASSERT_TRUE(keep_smooth(s, {}, list));
  ASSERT_TRUE(keep_poles(s, 1e-9, 1e-6, list));
  const Surface after = sculpted(s, list, {ball(Point(0.2, 0.3, 1.1), 0.4)});
  for (const double u : {1.0, 2.0, 3.0}) EXPECT_LT(crease(after, 0, u), 1e-9);
  EXPECT_LT(crease(after, 1, 1), 1e-9);
  const Points pole = on_line(after, 1, 2, 0, Side::right),
               across = on_line(after, 1, 2, 1, Side::right);
  EXPECT_LT((pole.rowwise() - pole.row(0)).cwiseAbs().maxCoeff(), 1e-12);
  const Point normal = Point(across.row(0)).cross(Point(across.row(10))).normalized();
  for (Eigen::Index k = 0; k < across.rows(); ++k) {
    EXPECT_LT(std::abs(normal.dot(across.row(k).transpose().normalized())), 1e-9);
  }
}

TEST(SculptedUnderConstraints, EdgesPinsCurvesAndRegionsStay) {
  for (const double spread : {1.0, 3.0}) {
    for (const KnotVector& u : {uniform_clamped(3, 7), uniform_unclamped(3, 7)}) {
      const Surface s = relief(u, uniform_unclamped(2, 8), 3, 0.03, spread);
      const double a = u.domain().lower;
      ConstraintList list(s.size());
      ASSERT_TRUE(hold_edge(s, SurfaceEdge::u0, 1, list));
      ASSERT_TRUE(hold_edge(s, SurfaceEdge::v1, 0, list));
      ASSERT_TRUE(pin_point(s, a + 6.2, 3.7, {}, list));
      ASSERT_TRUE(freeze_region(s, {a + 6, a + 6.5}, {8, 8.5}, list));
      Parameters<2> line(2, 2);
      line << a + 1.5, 4, a + 4.5, 9;
      const auto kept = keep_curve(s, line, 1e-9, list);
      ASSERT_TRUE(kept);
      const Surface after = sculpted(s, list, {ball(Point(0.75, 0.3, 0.12), 0.2)});
      const double size = size_of(s);
      for (int k = 0; k <= 1; ++k) {
        EXPECT_LT((on_line(after, 0, a, k, Side::right) - on_line(s, 0, a, k, Side::right))
                      .cwiseAbs()
                      .maxCoeff(),
                  1e-10 * size);
      }
      EXPECT_LT((on_line(after, 1, 10, 0, Side::right) - on_line(s, 1, 10, 0, Side::right))
                    .cwiseAbs()
                    .maxCoeff(),
                1e-10 * size);
      Parameters<2> at(102, 2);
      at.row(0) << a + 6.2, 3.7;
      at.row(1) << a + 6.3, 8.2;
      for (int t = 0; t < 100; ++t)
        at.row(2 + t) = line.row(0) + t / 99.0 * (line.row(1) - line.row(0));
      EXPECT_LT((evaluate(after, at)->points() - evaluate(s, at)->points()).cwiseAbs().maxCoeff(),
                1e-10 * size);
    }
  }
}

TEST(SculptedUnderConstraints, SymmetryOutlastsToolsThatAreNotSymmetric) {
  // Straight across every edge, symmetric in u about x = 1/2.
  const Surface s = uniform_sheet(3, 10, 8);
  const std::vector<Tool> tools = {ball(Point(0.3, 0.45, 0.1), 0.2)};
  const MirrorPlane middle{Point(0.5, 0, 0), Point::UnitX()};
  ConstraintList mirror(s.size());
  ASSERT_TRUE(keep_mirror(s, 0, middle, 1e-9, mirror));
  EXPECT_LT(mirror_report(sculpted(s, mirror, tools), 0, middle, 1e-9)->shape, 1e-10);
  EXPECT_GT(mirror_report(sculpted(s, ConstraintList(s.size()), tools), 0, middle, 1e-9)->shape,
            5e-3);

  ConstraintList half(s.size());
  ASSERT_TRUE(hold_symmetry_plane(s, SurfaceEdge::u0, {Point::Zero(), Point::UnitX()}, 1, 1e-9,
                                  1e-9, half));
  const Surface after = sculpted(s, half, {ball(Point(0.1, 0.45, 0.1), 0.2)});
  const Points edge = on_line(after, 0, 0, 0, Side::right),
               across = on_line(after, 0, 0, 1, Side::right);
  EXPECT_LT(edge.col(0).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(across.rightCols<2>().cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_GT(edge.col(2).cwiseAbs().maxCoeff(), 0.01);
}

}  // namespace
}  // namespace knead
