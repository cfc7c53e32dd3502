// Interactive accuracy against exact: one step, and strokes of 200 frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "active.hpp"

namespace knead {
namespace {

using testing::active;
using testing::ball_above_sheet;
using testing::box;
using testing::sheet_settings;

/// A path that presses in, circles, and lifts off again.
Point place(int frame, int frames) {
  const double t = static_cast<double>(frame) / frames, angle = 2 * std::numbers::pi * t;
  return {0.5 + 0.2 * std::cos(angle), 0.5 + 0.2 * std::sin(angle),
          0.16 - 0.08 * std::sin(std::numbers::pi * t)};
}

/// √(XᵀKX) of a difference of control points.
double energy_norm(const ActiveSurface& model, const Surface& rest, const Points& difference) {
  return std::sqrt(model.energy(rest.control_points() + difference));
}

/// The largest error of an interactive step, as a share of the step, in the energy norm.
double largest_error(int net, StepSolver solver) {
  const Surface s = box<2>(3, net);
  double largest = 0;
  for (const double stiffness : {1e2, 1e4, 1e7}) {
    ActiveSettings<2> settings = sheet_settings(s, StepAccuracy::exact);
    settings.evolution = Evolution::stationary;  // its matrix is K
    const auto exact = active<2>(s, settings);
    settings.accuracy = StepAccuracy::interactive;
    settings.solver = solver;
    const auto quick = active<2>(s, settings);
    Tool tool = ball_above_sheet(stiffness);
    testing::move_to(tool, Point(0.45, 0.52, 0.09));
    const auto a = exact.step(s.control_points(), {&tool, 1}),
               b = quick.step(s.control_points(), {&tool, 1});
    if (!a || !b) {
      ADD_FAILURE() << stiffness;
      return 1;
    }
    EXPECT_TRUE(a->converged && b->converged) << stiffness;
    const double step = energy_norm(exact, s, a->control_points - s.control_points());
    EXPECT_GT(step, 0);
    largest =
        std::max(largest, energy_norm(exact, s, b->control_points - a->control_points) / step);
  }
  return largest;
}

TEST(InteractiveAccuracy, HoldsInTheEnergyNormOfAStep) {
  EXPECT_LE(largest_error(24, StepSolver::automatic), interactive_accuracy);
}

TEST(InteractiveAccuracy, HoldsToTwiceAsMuchByIteration) {
  EXPECT_LE(largest_error(40, StepSolver::iterative), 2 * interactive_accuracy);
}

struct Stroked {
  double error = 0;  ///< largest difference of control points in any frame, as a share of the
                     ///< largest displacement
  double late = 0;   ///< the same over the second half
  int solves_exact = 0, solves_quick = 0;
};

Stroked stroke(Tool tool, const ActiveLoads& loads = {}) {
  constexpr int frames = 200;
  const Surface s = box<2>(3, 24);
  const auto exact = active<2>(s, sheet_settings(s, StepAccuracy::exact)),
             quick = active<2>(s, sheet_settings(s, StepAccuracy::interactive));
  ActiveState a{s.control_points()}, b = a;
  Stroked result;
  double displacement = 0;
  for (int k = 0; k < frames; ++k) {
    testing::move_to(tool, place(k, frames));
    const auto on_a = exact.step(a, {&tool, 1}, loads), on_b = quick.step(b, {&tool, 1}, loads);
    if (!on_a || !on_b || !on_a->converged || !on_b->converged) {
      ADD_FAILURE() << "frame " << k;
      return result;
    }
    a.control_points = on_a->control_points;
    b.control_points = on_b->control_points;
    displacement =
        std::max(displacement, (a.control_points - s.control_points()).cwiseAbs().maxCoeff());
    if (displacement == 0) continue;
    const double error = (a.control_points - b.control_points).cwiseAbs().maxCoeff() / displacement;
    result.error = std::max(result.error, error);
    if (2 * k >= frames) result.late = std::max(result.late, error);
    result.solves_exact += on_a->solves;
    result.solves_quick += on_b->solves;
  }
  return result;
}

// Steps are contractions: errors of earlier frames fade and do not add up.
TEST(InteractiveAccuracy, StaysBoundedOverStrokes) {
  for (const double stiffness : {1e2, 1e4, 1e7}) {
    const Stroked s = stroke(ball_above_sheet(stiffness));
    EXPECT_LE(s.error, interactive_accuracy) << stiffness;
    EXPECT_LE(s.late, interactive_accuracy) << stiffness;
    EXPECT_GT(s.error, 0) << stiffness;
    EXPECT_LT(s.solves_quick, s.solves_exact) << stiffness;
  }
}

TEST(InteractiveAccuracy, StaysBoundedWithFrictionAndLoads) {
  Tool rubbing = ball_above_sheet(1e4);
  rubbing.friction = 0.3;
  ActiveLoads loads;
  loads.force = Point(0, 0, 0.5);
  const Stroked s = stroke(rubbing, loads);
  EXPECT_LE(s.error, interactive_accuracy);
  EXPECT_LT(s.solves_quick, s.solves_exact);
}

TEST(InteractiveAccuracy, RepeatsBitForBit) {
  const Surface s = box<2>(3, 24);
  const Tool tool = ball_above_sheet(1e4);
  const auto once = active<2>(s, sheet_settings(s, StepAccuracy::interactive))
                        .step(s.control_points(), {&tool, 1});
  const auto again = active<2>(s, sheet_settings(s, StepAccuracy::interactive))
                         .step(s.control_points(), {&tool, 1});
  ASSERT_TRUE(once && again);
  EXPECT_EQ(once->control_points, again->control_points);
}

TEST(InteractiveAccuracy, LeavesStepsWithoutContactAsTheyAre) {
  const Surface s = box<2>(3, 24);
  ActiveLoads loads;
  loads.force = Point(0, 0, 1);
  const auto exact =
      active<2>(s, sheet_settings(s, StepAccuracy::exact)).step({s.control_points()}, {}, loads);
  const auto quick = active<2>(s, sheet_settings(s, StepAccuracy::interactive))
                         .step({s.control_points()}, {}, loads);
  ASSERT_TRUE(exact && quick);
  EXPECT_LE((exact->control_points - quick->control_points).cwiseAbs().maxCoeff(),
            1e-14 * exact->control_points.cwiseAbs().maxCoeff());
}

/// A load lifts the sheet from one ball, or from none, into others that are nowhere near it.
TEST(InteractiveAccuracy, HoldsForWhatComesIntoContactElsewhere) {
  const Surface s = box<2>(3, 24);
  const auto ball_at = [](double x, double y, double z, double stiffness) {
    return Tool{"ball", testing::sphere_at(Point(x, y, z), 0.1), ToolMode::collision, stiffness, 1};
  };
  const ActiveState start{s.control_points()};
  ActiveLoads loads;
  loads.force = Point(0, 0, 1);
  for (const double stiffness : {1e2, 1e4, 1e7}) {
    for (const bool touched : {false, true}) {
      std::vector<Tool> tools = {ball_at(0.7, 0.7, 0.12, stiffness),
                                 ball_at(0.3, 0.65, 0.12, stiffness)};
      if (touched) tools.push_back(ball_at(0.35, 0.3, 0.095, stiffness));
      ActiveSettings<2> settings = sheet_settings(s, StepAccuracy::exact);
      settings.evolution = Evolution::stationary;
      const auto exact = active<2>(s, settings);
      settings.accuracy = StepAccuracy::interactive;
      const auto quick = active<2>(s, settings);
      const auto free = exact.step(start, {}, loads), a = exact.step(start, tools, loads),
                 b = quick.step(start, tools, loads);
      ASSERT_TRUE(free && a && b);
      EXPECT_TRUE(a->converged && b->converged);
      const double step = energy_norm(exact, s, a->control_points - s.control_points());
      EXPECT_GT(energy_norm(exact, s, a->control_points - free->control_points), 0.005 * step)
          << "nothing is touched";
      EXPECT_LE(energy_norm(exact, s, b->control_points - a->control_points),
                interactive_accuracy * step)
          << stiffness << touched;
    }
  }
}

}  // namespace
}  // namespace knead
