// Rigid tools, limits, loads, friction and constraints in steps.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "active.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {
namespace {

using testing::active;
using testing::box;
using testing::rim;

TEST(RigidTool, IsEnteredByLessThanAFractionOfItsSize) {
  const Surface s = box<2>(3, 20);
  ActiveSettings<2> settings;
  settings.held = rim(s, 2);
  settings.detail = 0.2;
  Tool ball = {"ball", testing::sphere_at(Point(0.5, 0.47, 0.15), 0.2), ToolMode::collision, 100,
               1};
  ball.rigid = true;
  const auto step = active<2>(s, settings).step({s.control_points()}, {&ball, 1});
  ASSERT_TRUE(step);
  EXPECT_TRUE(step->converged) << step->note;
  EXPECT_LE(step->gap, rigid_gap);
  EXPECT_GT(step->gap, 0);
  EXPECT_EQ(step->gap_tool, "ball");
}

TEST(RigidTool, SaysWhyWhatIsHeldInsideItStaysThere) {
  const Surface s = box<2>(3, 10);
  ActiveSettings<2> settings;
  settings.held = rim(s, 2);
  settings.detail = 0.2;
  Tool ball = {"ball", testing::sphere_at(Point(0.5, 0, 0.1), 0.2), ToolMode::collision, 1e4, 1};
  ball.rigid = true;
  const auto step = active<2>(s, settings).step({s.control_points()}, {&ball, 1});
  ASSERT_TRUE(step);
  EXPECT_FALSE(step->converged);
  EXPECT_NE(step->note.find("ball"), std::string::npos);
}

TEST(Limit, HoldsToAMillionth) {
  const Surface s = box<2>(3, 16);
  ActiveSettings<2> settings;
  settings.held = rim(s, 1);
  settings.detail = 0.2;
  const Tool ball = {"ball", testing::sphere_at(Point(0.5, 0.47, 0.1), 0.2), ToolMode::collision,
                     1e4, 1};
  const ActiveSpline<2> model = active<2>(s, settings);
  ActiveState state{s.control_points()};
  ActiveLoads loads;
  for (double limit : {1.0, 0.03, 0.01}) {
    loads.limit = limit;
    auto step = model.step(state, {&ball, 1}, loads);
    ASSERT_TRUE(step);
    const double way =
        largest_norm(*s.with_control_points(step->control_points - s.control_points())).value;
    if (limit == 1.0) {
      EXPECT_GT(way, 0.05);
      EXPECT_FALSE(step->limited);
    } else {
      EXPECT_LE(way, limit * (1 + 1e-6));
      EXPECT_GT(way, limit * (1 - 1e-4));
      EXPECT_TRUE(step->limited);
    }
  }
}

TEST(Loads, PressureOnAFlatSheetIsALoadAlongItsNormal) {
  const Surface s = box<2>(3, 9);
  ActiveSettings<2> settings;
  settings.evolution = Evolution::stationary;
  settings.held = rim(s, 1);
  const ActiveSpline<2> model = active<2>(s, settings);
  ActiveLoads pressure, force;
  pressure.pressure = 0.01;
  force.force = Point(0, 0, 0.01);
  const Points a = model.step({s.control_points()}, {}, pressure)->control_points;
  const Points b = model.step({s.control_points()}, {}, force)->control_points;
  EXPECT_GT((b - s.control_points()).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Friction, AHeavySheetOnASlantStaysOrSlides) {
  // A sheet lying on a ball so large that it is a slant of slope 0.5.
  const Surface s = box<2>(2, 4);
  const double radius = 1e4;
  const Point up = Point(-0.5, 0, 1).normalized();
  ActiveSettings<2> settings;
  settings.evolution = Evolution::dynamic;
  settings.time_step = 0.06;
  settings.damping = 0;
  settings.detail = 10;
  ActiveLoads loads;
  loads.gravity = Point(0, 0, -1);
  Points start = s.control_points();
  for (int i = 0; i < start.rows(); ++i) start(i, 2) = 0.5 * start(i, 0);  // in the slant
  const auto way = [&](double friction) {
    Tool ground = {"ground", testing::sphere_at(Point(0.5, 0.5, 0.25) - radius * up, radius),
                   ToolMode::collision, 1e4, 1};
    ground.friction = friction;
    const Surface tilted = *s.with_control_points(start);
    const ActiveSpline<2> model = active<2>(tilted, settings);
    ActiveState state{start};
    for (int k = 0; k < 20; ++k) {
      auto step = model.step(state, {&ground, 1}, loads);
      if (!step) {
        ADD_FAILURE() << step.error().message();
        break;
      }
      state.control_points = step->control_points;
      state.velocity = step->velocity;
    }
    return (state.control_points - start).rowwise().norm().maxCoeff();
  };
  const double slides = way(0.1), stays = way(1.0), without = way(0);
  EXPECT_LT(stays, 0.02);  // the ground is a spring that gives a little, and the ball is round
  EXPECT_GT(slides, 0.2);
  EXPECT_GT(without, slides);
  // Without friction: g sin(slope) t²/2, with 0.1: (sin − 0.1 cos) g t²/2.
  // Gravity is in units of the model: its length is the root of its area.
  const double length = std::pow(1.25, 0.25), t = 20 * 0.06, sine = 0.5 / std::sqrt(1.25),
               cosine = 1 / std::sqrt(1.25);
  EXPECT_NEAR(without, 0.5 * sine * t * t * length, 0.01 * without);
  EXPECT_NEAR(slides, 0.5 * (sine - 0.1 * cosine) * t * t * length, 0.03 * slides);
}

TEST(Step, ThatRunsAwayIsRefused) {
  const Surface s = box<2>(3, 8);
  ActiveSettings<2> settings;
  settings.lambda = 1e-9;
  const ActiveSpline<2> model = active<2>(s, settings);
  ActiveLoads load;
  load.force = Point(0, 0, 1);
  const auto refused = model.step({s.control_points()}, {}, load);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::numerical);
  EXPECT_NE(refused.error().remedy.find("lambda"), std::string::npos);
}

TEST(SeveralPatches, CoupledMoveTogetherAndUncoupledTear) {
  const Surface s = box<2>(3, 8);
  Points right = s.control_points();
  right.col(0).array() += 1;
  const Surface t = *s.with_control_points(right);
  ActiveSettings<2> settings;
  settings.detail = 0.2;
  const Tool ball = {"ball", testing::sphere_at(Point(0.9, 0.5, 0.15), 0.2), ToolMode::collision,
                     1e4, 1};
  const auto gap = [&](bool coupled) {
    settings.constraints.clear();
    for (int j = 0; coupled && j < 8; ++j)
      settings.constraints.push_back({"seam", {{56 + j, 1}, {64 + j, -1}}});
    const auto model = ActiveSpline<2>::create({s, t}, settings);
    EXPECT_TRUE(model) << model.error().message();
    ActiveState state{Points(128, 3)};
    state.control_points << s.control_points(), right;
    for (int k = 0; k < 10; ++k) {
      auto step = model->step(state, {&ball, 1});
      if (!step) {
        ADD_FAILURE() << step.error().message();
        return 0.0;
      }
      state.control_points = step->control_points;
    }
    return (state.control_points.middleRows(56, 8) - state.control_points.middleRows(64, 8))
        .rowwise()
        .norm()
        .maxCoeff();
  };
  EXPECT_GT(gap(false), 0.01);
  EXPECT_LT(gap(true), 1e-12);
}

TEST(Constraints, APulledPointArrivesAndTheRestFollows) {
  const Surface s = box<2>(3, 10);
  ActiveSettings<2> settings;
  settings.held = rim(s, 1);
  const auto table_u = tabulate_basis(s.knots(0), std::vector{0.4}, 0),
             table_v = tabulate_basis(s.knots(1), std::vector{0.55}, 0);
  LinearConstraint pin{"pin", {}, Point(0, 0, 0.1)};
  for (int r = 0; r <= 3; ++r) {
    for (int c = 0; c <= 3; ++c) {
      pin.terms.emplace_back((table_u->first[0] + r) * 10 + table_v->first[0] + c,
                             table_u->row(0, 0)[r] * table_v->row(0, 0)[c]);
    }
  }
  settings.constraints = {pin};
  for (RestMode mode : {RestMode::shape, RestMode::none}) {
    settings.rest = mode;
    settings.evolution = Evolution::stationary;
    const auto step = active<2>(s, settings).step({s.control_points()}, {});
    ASSERT_TRUE(step);
    const Point at = *evaluate_point<2>(*s.with_control_points(step->control_points), {0.4, 0.55});
    EXPECT_LT((at - Point(0.4, 0.55, 0.1)).norm(), 1e-12);
    EXPECT_LT(step->violation, 1e-12);
    EXPECT_LT(step->residual, 1e-10);
  }
}

}  // namespace
}  // namespace knead
