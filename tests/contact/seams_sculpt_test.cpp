#include "hold/seams_support.hpp"
#include "knead/contact/active_spline.hpp"
#include "knead/spline/extremum.hpp"
#include "support/tools.hpp"

namespace knead {
namespace {

using namespace knead::testing;

/// Patches with a ball pressed into them across a seam, and how far the seam opened on the way.
struct Sculpted {
  double gap = 0, angle = 0;  // largest change at any step: of the model's size; radians
  double moved = 0;           // largest displacement on the seam, of the model's size
};

Sculpted sculpt(const Coupled& c, const PlacedShape& ball, const std::vector<bool>& held,
                int steps = 6) {
  ActiveSettings<2> settings;
  settings.constraints = c.coupling.constraints;
  settings.held = held;
  settings.detail = ball.size();
  settings.lambda = 2;
  const auto model = ActiveSurface::create(c.patches, settings);
  if (!model) {
    ADD_FAILURE() << model.error().message();
    return {};
  }
  Points rest(c.space.size(), 3);
  Eigen::Index row = 0;
  double size = 0;
  for (const Surface& s : c.patches) {
    rest.middleRows(row, s.size()) = s.control_points();
    row += s.size();
    size = std::max(size, bounding_box(s).diagonal());
  }
  const std::vector<Tool> tools = {{"ball", ball, ToolMode::collision, 1e3, 1}};
  Points x = rest;
  Sculpted result;
  for (int k = 0; k < steps; ++k) {
    auto step = model->step(x, tools);
    if (!step) {
      ADD_FAILURE() << step.error().message();
      return result;
    }
    x = std::move(step->control_points);
    const auto after = displaced(c.patches, x - rest);
    for (const SeamReport& report : c.coupling.reports) {
      result.gap = std::max(result.gap, gap_change(c.patches, after, report.seam) / size);
      result.angle = std::max(result.angle, angle_change(c.patches, after, report.seam));
      const Points seam = sides(after, report.seam).a - sides(c.patches, report.seam).a;
      result.moved = std::max(result.moved, seam.rowwise().norm().maxCoeff() / size);
    }
  }
  return result;
}

/// Two patches of one sheet, the second turned, with a gap as a file may have it; the far edges are
/// held.
std::vector<Surface> two_patches(double gap) {
  const KnotVector across = uniform_clamped(3, 7), along = uniform_clamped(3, 8);
  const Surface left = sheet(across, along), right = sheet(uniform_clamped(2, 9), along, 1.5);
  Points a = left.control_points(), b = right.control_points();
  b.col(0).array() += 1;
  b.col(2).array() += gap;
  return {*left.with_control_points(a), turned(turned(*right.with_control_points(b), 0), 1)};
}

std::vector<bool> far_edges(const std::vector<Surface>& patches) {
  std::vector<bool> held;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto [m, n] = patches[k].net();
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < n; ++j) held.push_back(i == 0);
    }
  }
  return held;
}

TEST(SeamSculpting, TwoPatchesStayTogetherUnderABallOnTheirSeam) {
  const PlacedShape ball = testing::sphere_at(Point(1.02, 0.45, 0.2), 0.3);
  for (double gap : {0.0, 1e-4}) {
    const auto patches = two_patches(gap);
    const auto held = far_edges(patches);
    const Coupled c(patches);
    ASSERT_EQ(c.coupling.reports.size(), 1u);
    ASSERT_EQ(c.report().continuity, SeamContinuity::g1) << c.report().reason;
    EXPECT_TRUE(c.report().seam.reversed);
    EXPECT_NEAR(c.report().seam.gap, gap, 1e-15);
    const Sculpted smooth = sculpt(c, ball, held);
    EXPECT_GT(smooth.moved, 0.02);  // there was something to tear
    EXPECT_LT(smooth.gap, 1e-12);
    EXPECT_LT(smooth.angle, 1e-6);

    // Without tangents a hinge, without coupling the tear of thesis Fig. 6.11.
    const Sculpted hinge = sculpt(Coupled(patches, {.most = SeamContinuity::c0}), ball, held);
    EXPECT_LT(hinge.gap, 1e-12);
    EXPECT_GT(hinge.angle, 1e-3);
    const Sculpted torn = sculpt(Coupled(patches, {.most = SeamContinuity::none}), ball, held);
    EXPECT_GT(torn.gap, 1e-3);
    RecordProperty("tear", std::to_string(torn.gap));
    std::printf("gap %.0e: g1 %.1e of the size, %.1e rad; c0 %.1e, %.1e rad; torn %.1e, %.1e rad\n",
                gap, smooth.gap, smooth.angle, hinge.gap, hinge.angle, torn.gap, torn.angle);
  }
}

TEST(SeamSculpting, AClosedCylinderStaysClosedUnderABallOnItsSeam) {
  // Exact: degree 2 × 1 with weights as in every CAD file, more rows along the axis for the dent.
  const Surface quarter = cylinder(2);
  const KnotVector along = uniform_clamped(3, 8);
  const int n = along.count();
  Points points(9 * n, 3);
  std::vector<double> weights;
  std::vector<bool> held;
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < n; ++j) {
      points.row(i * n + j) = quarter.control_points().row(2 * i);
      points(i * n + j, 2) = 2 * along.greville(j) / along.domain().upper;
      weights.push_back(quarter.weights()[static_cast<std::size_t>(2 * i)]);
      held.push_back(j == 0 || j == n - 1);
    }
  }
  const Surface tube = make_surface(quarter.knots(0), along, points, weights);
  const PlacedShape ball = testing::sphere_at(Point(1.1, 0.05, 1.1), 0.3);
  const Coupled c({tube});
  ASSERT_EQ(c.coupling.reports.size(), 1u);
  ASSERT_EQ(c.report().continuity, SeamContinuity::g1) << c.report().reason;
  const Sculpted smooth = sculpt(c, ball, held);
  EXPECT_GT(smooth.moved, 0.01);
  EXPECT_LT(smooth.gap, 1e-12);
  EXPECT_LT(smooth.angle, 1e-6);
  const Sculpted torn = sculpt(Coupled({tube}, {.most = SeamContinuity::none}), ball, held);
  EXPECT_GT(torn.gap, 1e-3);
  std::printf("cylinder: g1 %.1e of the size, %.1e rad; torn %.1e, %.1e rad\n", smooth.gap,
              smooth.angle, torn.gap, torn.angle);
}

TEST(SeamSculpting, APeriodicTubeStaysPeriodic) {
  const KnotVector u = uniform_unclamped(3, 12), v = uniform_clamped(3, 6);
  Points points(u.count() * v.count(), 3);
  std::vector<bool> held;
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j) {
      const double a = 2 * std::numbers::pi * (i % 12) / 12;
      points.row(i * v.count() + j) << std::cos(a), std::sin(a), v.greville(j) / 3;
      held.push_back(j == 0 || j == v.count() - 1);
    }
  }
  const Surface tube = make_surface(u, v, points);
  const Coupled c({tube});
  ASSERT_EQ(c.report().continuity, SeamContinuity::periodic);
  const Point seam = *evaluate_point<2>(tube, {3.0, 3.0});
  const Sculpted smooth = sculpt(c, testing::sphere_at(1.05 * seam, 0.3), held);
  EXPECT_GT(smooth.moved, 0.01);
  EXPECT_LT(smooth.gap, 1e-12);
  EXPECT_LT(smooth.angle, 1e-6);
  EXPECT_GT(sculpt(Coupled({tube}, {.most = SeamContinuity::none}),
                   testing::sphere_at(1.05 * seam, 0.3), held)
                .gap,
            1e-3);
}

}  // namespace
}  // namespace knead
