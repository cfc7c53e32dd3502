#include "knead/tool/tool.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "support/tools.hpp"

namespace knead {
namespace {

ToolAction action_of(const Tool& tool, const Point& x) {
  return ModelTool(tool, Point::Zero(), 1).action(x);
}

Tool ball(ToolMode mode) { return {"ball", testing::sphere_at(Point(1, 2, 3), 0.5), mode, 7, 0.2}; }

TEST(Tool, CollisionPushesOutWhatHasEntered) {
  const ToolAction inside = action_of(ball(ToolMode::collision), Point(1.3, 2, 3));
  EXPECT_NEAR(inside.force.x(), 7 * 0.2, 1e-14);  // Hooke: k times the depth, outwards
  EXPECT_EQ(inside.force.y(), 0);
  EXPECT_NEAR(inside.potential, 0.5 * 7 * 0.04, 1e-14);
  const ToolAction outside = action_of(ball(ToolMode::collision), Point(1.6, 2, 3));
  EXPECT_EQ(outside.force.norm(), 0);
  EXPECT_FALSE(outside.active);
}

TEST(Tool, ProximityDrawsFromEitherSideWithinItsRange) {
  const Tool tool = ball(ToolMode::proximity);
  EXPECT_LT(action_of(tool, Point(1.6, 2, 3)).force.x(), 0);
  EXPECT_GT(action_of(tool, Point(1.4, 2, 3)).force.x(), 0);
  EXPECT_EQ(action_of(tool, Point(1.71, 2, 3)).force.norm(), 0);
  EXPECT_EQ(action_of(tool, Point(1.29, 2, 3)).force.norm(), 0);
  // Near the tool it is Hooke's law.
  EXPECT_NEAR(action_of(tool, Point(1.5 + 1e-5, 2, 3)).force.x(), -7 * 1e-5, 1e-11);
}

TEST(Tool, ForceIsMinusTheGradientOfThePotential) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> value(-0.8, 0.8);
  for (ToolMode mode : {ToolMode::collision, ToolMode::proximity}) {
    const Tool tool = ball(mode);
    for (int k = 0; k < 2000; ++k) {
      const Point x =
          tool.shape.placement().position + Point(value(random), value(random), value(random));
      const ToolAction at = action_of(tool, x);
      for (int c = 0; c < 3; ++c) {
        constexpr double h = 1e-5;
        Point left = x, right = x;
        left[c] -= h;
        right[c] += h;
        const double slope =
            (action_of(tool, right).potential - action_of(tool, left).potential) / (2 * h);
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
      const Point x =
          tool.shape.placement().position + Point(value(random), value(random), value(random));
      const double phi = (x - tool.shape.placement().position).norm() - 0.5;
      constexpr double h = 1e-5;
      if (std::abs(phi) < h || std::abs(std::abs(phi) - tool.range) < h || phi < -0.45)
        continue;  // kinks, centre
      ++compared;
      const ToolAction at = action_of(tool, x);
      for (int c = 0; c < 3; ++c) {
        Point left = x, right = x;
        left[c] -= h;
        right[c] += h;
        const Point slope = (action_of(tool, right).force - action_of(tool, left).force) / (2 * h);
        EXPECT_LE((slope + at.hessian.col(c)).norm(), 1e-5 * tool.stiffness);
      }
    }
    EXPECT_GT(compared, 1000);
  }
}

TEST(Tool, AtTheCentreThereIsNoDirectionAndNoForce) {
  for (ToolMode mode : {ToolMode::collision, ToolMode::proximity}) {
    const ToolAction a = action_of(ball(mode), Point(1, 2, 3));
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
  EXPECT_EQ(place([](Tool& t) { t.friction = -0.1; }), "friction");
  EXPECT_EQ(place([](Tool& t) { t.plasticity = 1.1; }), "plasticity");
  EXPECT_EQ(place([](Tool& t) { t.stiffness = -1; }), "stiffness");
  EXPECT_EQ(place([](Tool& t) { t.range = 0; }), "range");
  EXPECT_EQ(place([](Tool& t) { t.stiffness = 1e11; }), "stiffness");
}

TEST(ModelTool, SeesTheSameInOtherUnits) {
  // Coordinates (x − c)/L: potential and force scale as L⁻² and L⁻¹ of those of the file.
  const Point c(3, -1, 2);
  for (ToolMode mode : {ToolMode::collision, ToolMode::proximity}) {
    const Tool tool = ball(mode);
    const ModelTool model(tool, c, 4);
    for (double way : {0.35, 0.45, 0.55, 0.65}) {
      const Point x = Point(1, 2, 3) + way * Point(2, -1, 2) / 3;
      const ToolAction here = action_of(tool, x), there = model.action((x - c) / 4);
      EXPECT_NEAR(there.potential, here.potential / 16, 1e-14);
      EXPECT_LT((there.force - here.force / 4).norm(), 1e-13);
      EXPECT_LT((there.hessian - here.hessian).norm(), 1e-12);
      EXPECT_EQ(there.active, here.active);
    }
  }
}

TEST(ModelTool, NeverPassesOverABoxThatItActsOn) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> value(-1.5, 1.5), size(0, 0.6);
  for (const Shape& shape :
       {Shape(SphereShape{0.5}), Shape(TorusShape{0.6, 0.2}), Shape(BoxShape{{0.5, 0.2, 0.3}, 0.1}),
        Shape(PlaneShape{}), Shape(BowlShape{0.6, 0.1})}) {
    for (ToolMode mode : {ToolMode::collision, ToolMode::proximity}) {
      Tool tool = ball(mode);
      tool.shape = *PlacedShape::create(
          shape, {Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), Point(1, 2, 3), {1, 1, 1}});
      const ModelTool model(tool, Point(1, 2, 3), 1);
      int passed = 0, met = 0;
      for (int k = 0; k < 3000; ++k) {
        const Point lower(value(random), value(random), value(random));
        const Point upper = lower + Point(size(random), size(random), size(random));
        if (model.may_reach(lower, upper)) continue;
        ++passed;
        for (double s : {0.0, 0.3, 0.5, 0.8, 1.0}) {
          for (double t : {0.0, 0.4, 1.0})
            met += model.action(lower + Point(s, t, 1 - s).cwiseProduct(upper - lower)).active;
        }
      }
      EXPECT_GT(passed, 100);
      EXPECT_EQ(met, 0);
    }
  }
}

}  // namespace
}  // namespace knead
