#include "contact/active_shell.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "solve/shell_statics.hpp"
#include "support/surfaces.hpp"
#include "support/tools.hpp"

namespace knead {
namespace {

const ShellMaterial sheet_metal{1e5, 0.3, 0.02, 1e-3};

ShellEnergy energy_of(const Surface& rest, const ShellMaterial& material = sheet_metal) {
  auto made = ShellEnergy::create(rest, material);
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

ActiveShell shell_of(const Surface& rest, const ActiveShellSettings& settings,
                     const ShellMaterial& material = sheet_metal) {
  auto made = ActiveShell::create({rest}, energy_of(rest, material), settings);
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

ActiveStep step_of(const ActiveShell& shell, const ActiveState& state,
                   std::span<const Tool> tools = {}, const ActiveLoads& loads = {}) {
  auto made = shell.step(state, tools, loads);
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

/// The rows of the net at the edges where u is 0 or 1.
std::vector<bool> ends_of(const Surface& s) {
  std::vector<bool> held(static_cast<std::size_t>(s.size()), false);
  for (int j = 0; j < s.net()[1]; ++j)
    held[static_cast<std::size_t>(j)] = held[held.size() - 1 - static_cast<std::size_t>(j)] = true;
  return held;
}

Tool ball_at(const Point& centre, double radius) {
  return {.name = "ball", .shape = testing::sphere_at(centre, radius), .mode = ToolMode::collision};
}

TEST(ActiveShell, UnderSmallPressureIsTheLinearPlate) {
  // The normal of a plate that hardly moves stays: pressure is a dead load.
  const Surface rest = testing::uniform_sheet(3, 8, 8);
  const auto held = ends_of(rest);
  const ActiveShell shell = shell_of(rest, {.evolution = Evolution::stationary, .held = held});
  const ActiveStep step = step_of(shell, {rest.control_points()}, {}, {.pressure = 1e-6});
  std::vector<LinearConstraint> constraints;
  for (int i = 0; i < rest.size(); ++i) {
    if (held[static_cast<std::size_t>(i)]) constraints.push_back({"end", {{i, 1.0}}});
  }
  const auto plate = linear_displacement(energy_of(rest), rest.control_points(), constraints,
                                         energy_of(rest).area_load({0, 0, 1e-6}));
  ASSERT_TRUE(plate) << plate.error().message();
  const Points moved = step.control_points - rest.control_points();
  EXPECT_LT((moved - *plate).norm(),
            1e-6 * plate->norm());  // of the order of the turn, 1e-5, squared, and 1e-9 / t²
  EXPECT_TRUE(step.converged) << step.note;
}

TEST(ActiveShell, ABallDentsItAndEveryForceIsBalanced) {
  const Surface rest = testing::uniform_sheet(3, 14, 14);
  const ActiveShell shell =
      shell_of(rest, {.evolution = Evolution::stationary, .held = ends_of(rest), .detail = 0.15});
  ActiveStep step;
  ActiveState state{rest.control_points()};
  for (const double height : {0.13, 0.1, 0.07}) {
    const Tool ball = ball_at({0.5, 0.5, height}, 0.15);
    step = step_of(shell, state, {&ball, 1});
    EXPECT_TRUE(step.converged) << step.note;
    EXPECT_LT(step.residual, 1e-9);
    EXPECT_LT(step.gap, 5e-3);
    state.control_points = step.control_points;
  }
  const Surface now = *rest.with_control_points(step.control_points);
  // The nearest Gauss points are 0.022 away, where the ball is 0.0016 higher.
  EXPECT_NEAR((*evaluate_point<2>(now, {0.5, 0.5}))[2], 0.07 - 0.15, 0.0016 + step.gap * 0.15);
  EXPECT_GT(step.stretch, 0);
  EXPECT_GT(step.bend, 0);
  const ActiveStep again = step_of(shell, state, {}, {});
  EXPECT_LT(again.energy, 1e-12 * step.energy);  // without the ball it springs back
}

TEST(ActiveShell, InteractiveFramesAreBalancedAndComeToRest) {
  const Surface rest = testing::uniform_sheet(3, 16, 16);
  ActiveShellSettings settings{
      .evolution = Evolution::stationary, .held = ends_of(rest), .detail = 0.15};
  const ActiveShell exact = shell_of(rest, settings);
  settings.accuracy = StepAccuracy::interactive;
  const ActiveShell shell = shell_of(rest, settings);
  ActiveState state{rest.control_points()};
  Tool ball = ball_at({0.5, 0.5, 0.15}, 0.15);
  ActiveStep step;
  for (int frame = 1; frame <= 30; ++frame) {
    ball =
        ball_at({0.5 + 0.005 * std::min(frame, 20), 0.5, 0.15 - 0.004 * std::min(frame, 20)}, 0.15);
    step = step_of(shell, state, {&ball, 1});
    EXPECT_TRUE(step.converged) << step.note;
    EXPECT_LE(step.residual, 1e-3) << frame;
    state.control_points = step.control_points;
  }
  EXPECT_LE(step.residual, 1e-6);  // ten frames after the ball has stopped
  const ActiveStep at_rest = step_of(exact, state, {&ball, 1});
  EXPECT_LT((at_rest.control_points - state.control_points).norm(),
            1e-5 * (state.control_points - rest.control_points()).norm());
}

TEST(ActiveShell, ARigidBallStaysOutside) {
  const Surface rest = testing::uniform_sheet(3, 14, 14);
  const ActiveShell shell =
      shell_of(rest, {.evolution = Evolution::stationary, .held = ends_of(rest), .detail = 0.15});
  Tool ball = ball_at({0.5, 0.5, 0.1}, 0.15);
  ball.rigid = true;
  const ActiveStep step = step_of(shell, {rest.control_points()}, {&ball, 1});
  EXPECT_TRUE(step.converged) << step.note;
  EXPECT_LE(step.gap, 1.01e-4);
}

TEST(ActiveShell, FrictionDragsItAlong) {
  const Surface rest = testing::uniform_sheet(3, 12, 12);
  const ActiveShell shell =
      shell_of(rest, {.evolution = Evolution::stationary, .held = ends_of(rest), .detail = 0.15});
  const auto dragged = [&](double friction) {
    Tool ball = ball_at({0.5, 0.5, 0.11}, 0.15);
    ball.friction = friction;
    ActiveState state{rest.control_points()};
    for (int k = 0; k < 4; ++k) {
      testing::move_to(ball, {0.5, 0.5 + 0.01 * k, 0.11});
      const ActiveStep step = step_of(shell, state, {&ball, 1});
      EXPECT_TRUE(step.converged) << step.note;
      state.control_points = step.control_points;
    }
    const Surface now = *rest.with_control_points(state.control_points);
    return (*evaluate_point<2>(now, {0.5, 0.5}))[1] - 0.5;
  };
  EXPECT_GT(dragged(0.8), dragged(0) + 1e-5);
}

TEST(ActiveShell, RelaxesByStepsThatLowerItsEnergy) {
  const Surface rest =
      testing::relief(testing::uniform_clamped(3, 5), testing::uniform_clamped(3, 5), 3);
  const ActiveShell shell = shell_of(rest, {.evolution = Evolution::acm, .lambda = 1e-3});
  ActiveState state{rest.control_points() + 0.03 * testing::random_points(rest.size(), 8)};
  double last = shell.structure().energy(state.control_points).sum();
  for (int k = 0; k < 8; ++k) {
    const ActiveStep step = step_of(shell, state);
    EXPECT_TRUE(step.converged) << step.note;
    EXPECT_LT(step.energy, last);
    last = step.energy;
    state.control_points = step.control_points;
  }
}

/// A bent strip that is let go: energy and motion together never grow, however large the steps.
TEST(ActiveShell, NeverGainsEnergyInTime) {
  const Surface rest = testing::uniform_sheet(3, 9, 5, 1, 0.4);
  Points bent = rest.control_points();
  for (Eigen::Index i = 0; i < bent.rows(); ++i) {
    const double angle = 2.0 * bent(i, 0);  // rolled up by two radians
    bent.row(i) << std::sin(angle) / 2, bent(i, 1), (1 - std::cos(angle)) / 2;
  }
  for (const double h : {1e-7, 1e-5, 1e-3, 0.1}) {
    const ActiveShell shell =
        shell_of(rest, {.evolution = Evolution::dynamic, .time_step = h, .damping = 0});
    ActiveState state{bent};
    double last = shell.structure().energy(bent).sum();
    const double begin = last;
    for (int k = 0; k < 12; ++k) {
      const ActiveStep step = step_of(shell, state);
      EXPECT_TRUE(step.converged) << step.note << " at " << h;
      const double total = step.energy + step.kinetic;
      EXPECT_LE(total, last + 1e-7 * begin)
          << "step " << k << " of " << h;  // of the tolerance of the steps
      last = total;
      state.control_points = step.control_points;
      state.velocity = step.velocity;
    }
    if (h == 1e-7) {
      EXPECT_GT(last, 0.999 * begin);  // steps that resolve its waves keep it
    }
  }
}

TEST(ActiveShell, AFreeSheetFallsAndTurnsAsARigidBody) {
  const Surface rest = testing::uniform_sheet(3, 5, 5);
  const double h = 1e-4, rate = 3;
  const ActiveShell shell =
      shell_of(rest, {.evolution = Evolution::dynamic, .time_step = h, .damping = 0});
  const Points weight =
      energy_of(rest).area_load(Point(0, 0, -9.81) * energy_of(rest).mass_per_area());
  ActiveState state{rest.control_points()};
  state.velocity = Points::Zero(rest.size(), 3);
  for (int i = 0; i < rest.size(); ++i) {
    const Eigen::RowVector3d arm = rest.control_points().row(i) - Eigen::RowVector3d(0.5, 0.5, 0);
    state.velocity.row(i) = rate * Eigen::RowVector3d(0, 0, 1).cross(arm);
  }
  for (int k = 0; k < 20; ++k) {
    const ActiveStep step = step_of(shell, state, {}, {.nodal = weight});
    state.control_points = step.control_points;
    state.velocity = step.velocity;
  }
  const double t = 20 * h;
  const Point centre = state.control_points.colwise().mean().transpose();
  // v is exact; the place is that of V = (1 − θ) V₀ + θ V₁ in every step, g h (θ − ½) t further, θ
  // from 0.55 to 1.
  EXPECT_LE(centre[2], -0.5 * 9.81 * t * t - 9.81 * h * 0.05 * t + 1e-9);
  EXPECT_GE(centre[2], -0.5 * 9.81 * t * t - 9.81 * h * 0.5 * t - 1e-9);
  EXPECT_NEAR(centre[0], 0.5, 1e-9);
  const Eigen::RowVector3d side =
      state.control_points.bottomRows(1) - state.control_points.topRows(1);
  const double angle = std::atan2(side[1], side[0]) - std::numbers::pi / 4;
  EXPECT_NEAR(angle, rate * t, 1e-3 * rate * t);
}

/// Two sheets at a right angle, one clamped, that a load on the other bends far.
TEST(ActiveShell, KeepsTheAngleAtACreaseUnderLargeTurns) {
  const Surface a = testing::uniform_sheet(3, 6, 4, 1, 0.5);
  const Surface flat = testing::uniform_sheet(3, 6, 4, 1, 0.5);
  Points up = flat.control_points();
  for (Eigen::Index i = 0; i < up.rows(); ++i)
    up.row(i) << 1, flat.control_points()(i, 1), flat.control_points()(i, 0);
  const Surface b = *flat.with_control_points(up);
  const ShellEnergy shell = energy_of(a);
  auto crease = ShellCrease::create({&a, 0, 0, true}, {&b, a.size(), 0, false}, false,
                                    1000 * shell.bending_stiffness() / shell.effective_thickness());
  ASSERT_TRUE(crease) << crease.error().message();
  const ShellStructure structure({shell, energy_of(b)}, {*crease});
  std::vector<LinearConstraint> constraints;
  for (int j = 0; j < 4; ++j) {
    constraints.push_back({"seam", {{a.size() - 4 + j, 1.0}, {a.size() + j, -1.0}}});
    for (const int i : {0, 1}) constraints.push_back({"clamped", {{4 * i + j, 1.0}}});
  }
  Points load = Points::Zero(a.size() + b.size(), 3);
  load.bottomRows(4).col(0).setConstant(0.02);
  Points rest(a.size() + b.size(), 3);
  rest << a.control_points(), b.control_points();
  const auto found = shell_equilibrium(structure, rest, constraints, load, {.increments = 8});
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_TRUE(found->converged) << found->note;
  const Points& x = found->control_points;
  const Eigen::RowVector3d edge = x.row(a.size() - 4) - x.row(a.size() - 8);
  EXPECT_GT(std::abs(std::atan2(edge[2], edge[0])), 0.5);  // it has turned far
  EXPECT_LT(crease->opening(x), 1e-3);
}

TEST(ActiveShell, RefusesWhatItCannotDo) {
  const Surface rest = testing::uniform_sheet(3, 5, 5);
  ShellMaterial light = sheet_metal;
  light.density = 0;
  const auto made =
      ActiveShell::create({rest}, energy_of(rest, light), {.evolution = Evolution::dynamic});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().where, "density");
  EXPECT_FALSE(ActiveShell::create({rest}, energy_of(rest), {.lambda = -1}));
}

}  // namespace
}  // namespace knead
