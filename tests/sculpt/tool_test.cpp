#include "knead/sculpt/tool.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace knead {
namespace {

Tool ball(ToolMode mode) { return {"ball", {Point(1, 2, 3), 0.5}, mode, 7, 0.2}; }

TEST(Tool, CollisionPushesOutWhatHasEntered) {
  const ToolAction inside = tool_action(ball(ToolMode::collision), Point(1.3, 2, 3));
  EXPECT_NEAR(inside.force.x(), 7 * 0.2, 1e-14);  // Hooke: k times the depth, outwards
  EXPECT_EQ(inside.force.y(), 0);
  EXPECT_NEAR(inside.potential, 0.5 * 7 * 0.04, 1e-14);
  const ToolAction outside = tool_action(ball(ToolMode::collision), Point(1.6, 2, 3));
  EXPECT_EQ(outside.force.norm(), 0);
  EXPECT_FALSE(outside.active);
}

TEST(Tool, ProximityDrawsFromEitherSideWithinItsRange) {
  const Tool tool = ball(ToolMode::proximity);
  EXPECT_LT(tool_action(tool, Point(1.6, 2, 3)).force.x(), 0);
  EXPECT_GT(tool_action(tool, Point(1.4, 2, 3)).force.x(), 0);
  EXPECT_EQ(tool_action(tool, Point(1.71, 2, 3)).force.norm(), 0);
  EXPECT_EQ(tool_action(tool, Point(1.29, 2, 3)).force.norm(), 0);
  // Near the tool it is Hooke's law.
  EXPECT_NEAR(tool_action(tool, Point(1.5 + 1e-5, 2, 3)).force.x(), -7 * 1e-5, 1e-11);
}

TEST(Tool, ForceIsMinusTheGradientOfThePotential) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> value(-0.8, 0.8);
  for (ToolMode mode : {ToolMode::collision, ToolMode::proximity}) {
    const Tool tool = ball(mode);
    for (int k = 0; k < 2000; ++k) {
      const Point x = tool.shape.centre + Point(value(random), value(random), value(random));
      const ToolAction at = tool_action(tool, x);
      for (int c = 0; c < 3; ++c) {
        constexpr double h = 1e-5;
        Point left = x, right = x;
        left[c] -= h;
        right[c] += h;
        const double slope = (tool_action(tool, right).potential - tool_action(tool, left).potential) / (2 * h);
        // A central difference across the kink of ψ'' is off by up to k h / 4.
        EXPECT_NEAR(at.force[c], -slope, tool.stiffness * h);
      }
    }
  }
}

TEST(Tool, HessianIsTheDerivativeOfTheForce) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> value(-0.8, 0.8);
  for (ToolMode mode : {ToolMode::collision, ToolMode::proximity}) {
    const Tool tool = ball(mode);
    int compared = 0;
    for (int k = 0; k < 2000; ++k) {
      const Point x = tool.shape.centre + Point(value(random), value(random), value(random));
      const double phi = (x - tool.shape.centre).norm() - tool.shape.radius;
      constexpr double h = 1e-5;
      if (std::abs(phi) < h || std::abs(std::abs(phi) - tool.range) < h || phi < -0.45) continue;  // kinks, centre
      ++compared;
      const ToolAction at = tool_action(tool, x);
      for (int c = 0; c < 3; ++c) {
        Point left = x, right = x;
        left[c] -= h;
        right[c] += h;
        const Point slope = (tool_action(tool, right).force - tool_action(tool, left).force) / (2 * h);
        EXPECT_LE((slope + at.hessian.col(c)).norm(), 1e-5 * tool.stiffness);
      }
    }
    EXPECT_GT(compared, 1000);
  }
}

TEST(Tool, AtTheCentreThereIsNoDirectionAndNoForce) {
  for (ToolMode mode : {ToolMode::collision, ToolMode::proximity}) {
    const ToolAction a = tool_action(ball(mode), Point(1, 2, 3));
    EXPECT_EQ(a.force.norm(), 0);
    EXPECT_FALSE(a.active);
  }
}

TEST(Tool, NonsenseIsRefusedByField) {
  const auto place = [](auto change) {
    Tool tool = ball(ToolMode::proximity);
    change(tool);
    return validated(tool).error().where;
  };
  EXPECT_EQ(place([](Tool& t) { t.shape.radius = 0; }), "radius");
  EXPECT_EQ(place([](Tool& t) { t.shape.centre.y() = std::nan(""); }), "position");
  EXPECT_EQ(place([](Tool& t) { t.stiffness = -1; }), "stiffness");
  EXPECT_EQ(place([](Tool& t) { t.range = 0; }), "range");
  EXPECT_EQ(place([](Tool& t) { t.stiffness = 1e11; }), "stiffness");
}

}  // namespace
}  // namespace knead
