#include "tool/tool_load.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "base/interruption.hpp"
#include "sculpt/lattice.hpp"
#include "support/surfaces.hpp"
#include "support/tools.hpp"

namespace knead {
namespace {

const DomainScaling<2> raw{};

PotentialState evaluate(const ToolLoad<2>& load, const Points& x, std::span<const Tool> tools) {
  PotentialState state;
  state.force = Points::Zero(x.rows(), 3);
  std::vector<ModelTool> model;
  for (const Tool& tool : tools) model.emplace_back(tool, Point::Zero(), 1);
  load.evaluate(x, 0, 0, {.tools = model, .friction = nullptr, .limit = nullptr}, state);
  return state;
}

Points apply_hessian(const ToolLoad<2>& load, const PotentialState& state, const Points& v) {
  Points result = Points::Zero(v.rows(), 3);
  load.apply_hessian(state.contacts, 0, v, result);
  return result;
}

/// A sphere so large that a sheet in z = 0 sees a plane: every point enters by the same depth along
/// −z.
Tool half_space(double depth) {
  constexpr double radius = 1e7;
  return {"plane", testing::sphere_at(Point(0.5, 0.5, radius - depth), radius), ToolMode::collision,
          3, 1};
}

TEST(ToolLoad, OfAUniformPressureIsTheIntegralOfEveryBasisFunction) {
  // F_i = f ∫ N_i, and ∫ N_i = (x_{i+p+1} − x_i)/(p + 1) (thesis Thm 5.2).
  for (const auto& family : testing::knot_families(3)) {
    if (!family.ordinary() || !family.knots.clamped() || family.knots.count() > 40) continue;
    const KnotVector v = testing::uniform_clamped(2, 3);
    const Surface s = testing::sheet(family.knots, v);
    const auto load = ToolLoad<2>::create(s, raw, std::numeric_limits<double>::infinity());
    ASSERT_TRUE(load);
    const Tool tool = half_space(0.01);
    const auto state = evaluate(*load, s.control_points(), {&tool, 1});
    for (int i = 0; i < family.knots.count(); ++i) {
      for (int j = 0; j < v.count(); ++j) {
        const double area = (family.knots[i + 4] - family.knots[i]) / 4 * (v[j + 3] - v[j]) / 3;
        EXPECT_NEAR(state.force(i * v.count() + j, 2), -3 * 0.01 * area, 1e-6 * area)
            << family.name;
      }
    }
  }
}

TEST(ToolLoad, ForceIsMinusTheGradientOfThePotential) {
  for (const Surface& s :
       {testing::relief(testing::uniform_clamped(3, 3), testing::uniform_clamped(2, 4), 1),
        testing::relief(testing::uniform_clamped(2, 3), testing::uniform_clamped(2, 3), 2, 0.1,
                        5)}) {
    for (ToolMode mode : {ToolMode::collision, ToolMode::proximity}) {
      const Tool tool = {"ball", testing::sphere_at(Point(0.6, 0.4, 0.3), 0.35), mode, 10, 0.3};
      const auto load = ToolLoad<2>::create(s, DomainScaling<2>{1, {0.7, 1.3}}, 0.3);
      ASSERT_TRUE(load);
      const Points x = s.control_points(), direction = testing::random_points(x.rows(), 4);
      const auto state = evaluate(*load, x, {&tool, 1});
      EXPECT_GT(state.contacts.size(), 10U);
      constexpr double h = 1e-5;
      const double slope = (evaluate(*load, x + h * direction, {&tool, 1}).potential -
                            evaluate(*load, x - h * direction, {&tool, 1}).potential) /
                           (2 * h);
      EXPECT_NEAR(-state.force.cwiseProduct(direction).sum(), slope, 1e-4 * std::abs(slope));
    }
  }
}

TEST(ToolLoad, HessianIsSymmetricAndTheDerivativeOfTheForce) {
  const Surface s =
      testing::relief(testing::uniform_clamped(2, 4), testing::uniform_clamped(3, 4), 3, 0.1, 4);
  const Tool tool = {"ball", testing::sphere_at(Point(0.6, 0.4, 0.3), 0.35), ToolMode::proximity,
                     10, 0.3};
  const auto load = ToolLoad<2>::create(s, raw, 0.3);
  const auto state = evaluate(*load, s.control_points(), {&tool, 1});
  const Points a = testing::random_points(s.size(), 5), b = testing::random_points(s.size(), 6);
  const double ab = a.cwiseProduct(apply_hessian(*load, state, b)).sum();
  const double ba = b.cwiseProduct(apply_hessian(*load, state, a)).sum();
  EXPECT_NEAR(ab, ba, 1e-13 * a.norm() * b.norm());
  constexpr double h = 1e-6;
  const Points slope = (evaluate(*load, s.control_points() + h * a, {&tool, 1}).force -
                        evaluate(*load, s.control_points() - h * a, {&tool, 1}).force) /
                       (2 * h);
  EXPECT_LE((slope + apply_hessian(*load, state, a)).norm(), 1e-4 * slope.norm());
}

TEST(ToolLoad, UsesMorePointsForSmallerTools) {
  const Surface s = testing::uniform_sheet(3, 6, 6);
  const auto coarse = ToolLoad<2>::create(s, raw, std::numeric_limits<double>::infinity());
  const auto fine = ToolLoad<2>::create(s, raw, 0.02);
  EXPECT_EQ(coarse->points(), 12 * 12);
  EXPECT_GE(fine->points(), 300 * 300);  // six points per 0.02
}

ModelTool ball_of(double radius) {
  return {{"ball", testing::sphere_at(Point(0.6, 0.4, 0.15), radius), ToolMode::collision, 10, 1},
          Point::Zero(),
          1};
}

/// Near a shape that lies above it, but touches nothing. It has no bounds: no row of points is left
/// out because of it.
ModelTool plane_at(double height) {
  auto below = PlacedShape::create(
      PlaneShape{}, {Eigen::Quaterniond::Identity(), Point(0, 0, height), {1, 1, 1}});
  if (!below) ADD_FAILURE() << below.error().message();
  return {{"plane", std::move(*below), ToolMode::collision, 10, 1}, Point::Zero(), 1};
}

template <int D>
PotentialState evaluate(const ToolLoad<D>& load, const Points& x, std::vector<ModelTool> tools) {
  PotentialState state;
  state.force = Points::Zero(x.rows(), 3);
  load.evaluate(x, 0, 0, {.tools = tools, .friction = nullptr, .limit = nullptr}, state);
  return state;
}

template <int D>
void expect_the_same_beside_a_plane(const Spline<D>& spline, double height) {
  const auto load = ToolLoad<D>::create(spline, DomainScaling<D>{}, 0.1);
  ASSERT_TRUE(load);
  const Points x = spline.control_points();
  ASSERT_TRUE(evaluate(*load, x, {plane_at(height)}).contacts.empty());
  const PotentialState alone = evaluate(*load, x, {ball_of(0.2)});
  const PotentialState beside = evaluate(*load, x, {ball_of(0.2), plane_at(height)});
  ASSERT_GT(alone.contacts.size(), 20U);
  EXPECT_EQ(alone.contacts.size(), beside.contacts.size());
  EXPECT_EQ(alone.potential, beside.potential);
  EXPECT_EQ(alone.force, beside.force);
}

TEST(ToolLoad, IsTheSameBitForBitWhereRowsOfPointsFarFromToolsAreLeftOut) {
  expect_the_same_beside_a_plane(
      testing::relief(testing::uniform_clamped(3, 3), testing::uniform_clamped(2, 4), 1), -0.2);
  expect_the_same_beside_a_plane(
      testing::relief(testing::uniform_clamped(2, 3), testing::uniform_clamped(2, 3), 2, 0.1, 5),
      -0.2);
  const auto block =
      Lattice::create({Point(0, 0, -0.5), Point(1, 1, 0.5)}, 0.05, {3, 3, 3}, {4, 5, 4});
  ASSERT_TRUE(block);
  expect_the_same_beside_a_plane(block->rest(), -0.65);
}

TEST(ToolLoad, OfAToolInACornerOfAnElementAsksInThatCorner) {
  const auto block =
      Lattice::create({Point(0, 0, -0.5), Point(1, 1, 0.5)}, 0.05, {3, 3, 3}, {4, 4, 4});
  ASSERT_TRUE(block);
  const auto load = ToolLoad<3>::create(block->rest(), DomainScaling<3>{}, 0.1);
  ASSERT_TRUE(load);
  const PotentialState alone = evaluate(*load, block->rest().control_points(), {ball_of(0.1)});
  EXPECT_FALSE(alone.contacts.empty());
  EXPECT_LT(alone.visited, load->points() / 50);
  // A shape without bounds that is touched nowhere is asked at few points more.
  const PotentialState beside =
      evaluate(*load, block->rest().control_points(), {ball_of(0.1), plane_at(-0.65)});
  EXPECT_LT(beside.visited, load->points() / 5);
}

TEST(ToolLoad, WithoutToolsIsZero) {
  const Surface s = testing::uniform_sheet(3, 6, 6);
  const auto state = evaluate(*ToolLoad<2>::create(s, raw, 1), s.control_points(), {});
  EXPECT_EQ(state.force.norm(), 0);
  EXPECT_EQ(state.potential, 0);
}

/// A thin tool at a flat sheet of few spans: hundreds of Gauss points in each.
Tool thin_tool(double friction) {
  const auto shape = PlacedShape::create(
      SuperellipsoidShape{{0.3, 0.02, 0.1}, 0.7, 1.4},
      {Eigen::Quaterniond(0.9, 0.1, 0.3, 0.2).normalized(), Point(0.5, 0.5, 0), {1, 1, 1}});
  return {"thin", *shape, ToolMode::collision, 100, 1, false, friction};
}

TEST(ToolLoad, AsksWithinAnElementWhetherToGoOn) {
  const Surface sheet = testing::uniform_sheet(3, 4, 4);
  const auto load = ToolLoad<2>::create(sheet, raw, 0.02);
  ASSERT_TRUE(load);
  const std::vector<ModelTool> tools = {ModelTool(thin_tool(0.5), Point::Zero(), 1)};
  const Points& x = sheet.control_points();
  const auto elements =
      static_cast<long long>(sheet.knots(0).spans().size() * sheet.knots(1).spans().size());
  const auto grip = [&] { return load->anchors(x, 0, tools, 1e-4).anchors.size(); };
  const auto press = [&] {
    PotentialState state;
    state.force = Points::Zero(x.rows(), 3);
    load->evaluate(x, 0, 0, {.tools = tools, .friction = nullptr, .limit = nullptr}, state);
    return state.contacts.size();
  };
  const auto enter = [&] {
    return load->deepest_entry(x, 0, tools.front()).depth > 0 ? std::size_t{1} : std::size_t{0};
  };
  for (const std::function<std::size_t()>& ask :
       {std::function<std::size_t()>(grip), {press}, {enter}}) {
    long long asked = 0;
    std::size_t whole = 0;
    {
      const Interruption counts([&] { return ++asked > 0; });
      whole = ask();
    }
    EXPECT_GT(whole, 0U);
    EXPECT_GT(asked, 10 * elements);
    const Interruption stops([&] { return --asked > 0; });
    asked = 4 * elements;
    EXPECT_LE(ask(), whole);
    EXPECT_TRUE(stops.happened());
  }
}

/// The forces of tools on a patch, each on its own grid.
PotentialState on_grids(const ToolGrids<2>& grids, const Points& x,
                        const std::vector<Tool>& tools) {
  PotentialState state;
  state.force = Points::Zero(x.rows(), 3);
  std::vector<ModelTool> model;
  for (const Tool& tool : tools) model.emplace_back(tool, Point::Zero(), 1);
  for (const ToolLoad<2>& grid : grids) {
    grid.evaluate(x, 0, 0, {.tools = model, .friction = nullptr, .limit = nullptr}, state);
  }
  return state;
}

TEST(ToolGrids, AskALargeToolNoMoreOftenBesideASmallOne) {
  const Surface sheet = testing::uniform_sheet(3, 6, 6);
  const Tool ball = {"ball", testing::sphere_at(Point(0.3, 0.3, 0.15), 0.2)},
             pin = {"pin",
                    testing::sphere_at(Point(0.8, 0.8, 0.001), 0.002),
                    ToolMode::collision,
                    1e4,
                    0.5,
                    false,
                    0.4};
  const auto beside = ToolGrids<2>::create(sheet, raw, pin.detail());
  const auto alone = ToolLoad<2>::create(sheet, raw, ball.detail());
  ASSERT_TRUE(beside && alone);
  EXPECT_GT((*beside)[0].points(), 1000 * alone->points());
  const Points& x = sheet.control_points();
  const PotentialState of_ball = evaluate(*alone, x, {&ball, 1}),
                       of_both = on_grids(*beside, x, {ball, pin}),
                       of_pin = on_grids(*beside, x, {pin});
  ASSERT_GT(of_ball.contacts.size(), 50U);
  ASSERT_GT(of_pin.contacts.size(), 10U);
  EXPECT_LE(of_both.visited - of_pin.visited, 4 * of_ball.visited);
  // What each does is what it does alone on a grid that is fine enough for it.
  EXPECT_LE((of_both.force - of_pin.force - of_ball.force).norm(), 0.01 * of_ball.force.norm());
  const PotentialState of_ball_here = on_grids(*beside, x, {ball});
  EXPECT_EQ(of_both.contacts.size(), of_ball_here.contacts.size() + of_pin.contacts.size());
  // Their rows of anchors of friction are those of what they touch, not of the whole grid.
  const ModelTool rubbing(pin, Point::Zero(), 1);
  const FrictionAnchors anchors = (*beside)[0].anchors(x, 0, {&rubbing, 1}, 1e-4);
  EXPECT_EQ(anchors.anchors.size(), of_pin.contacts.size());
  EXPECT_LE(static_cast<long long>(anchors.index.size()), (*beside)[0].points() / 9);
}

TEST(ToolGrids, HaveOneForEveryToolAndOnlyOne) {
  const Surface sheet = testing::uniform_sheet(3, 6, 6);
  const auto grids = ToolGrids<2>::create(sheet, raw, 0.003);
  ASSERT_TRUE(grids);
  for (double radius : {1e-4, 0.003, 0.0059, 0.006, 0.0061, 0.1, 1.0, 1e9}) {
    const ModelTool ball({"ball", testing::sphere_at(Point::Zero(), radius)}, Point::Zero(), 1);
    EXPECT_EQ(std::ranges::count_if(*grids, [&](const auto& grid) { return grid.takes(ball); }), 1)
        << radius;
  }
  EXPECT_EQ(grids->coarsest().points(), 12 * 12);
  EXPECT_TRUE(grids->coarsest().takes(plane_at(0)));
}

TEST(ToolGrids, ResolveTheRangeOfAProximityToolAndNotItsThickness) {
  const Surface sheet = testing::uniform_sheet(3, 6, 6);
  const auto thin =
      PlacedShape::create(EllipsoidShape{{0.3, 0.002, 0.2}},
                          {Eigen::Quaterniond::Identity(), Point(0.5, 0.5, 0), {1, 1, 1}});
  ASSERT_TRUE(thin);
  const Tool tool = {"thin", *thin, ToolMode::proximity, 10, 0.2};
  EXPECT_EQ(tool.detail(), 0.2);
  const auto coarse = ToolLoad<2>::create(sheet, raw, tool.detail()),
             fine = ToolLoad<2>::create(sheet, raw, 0.01);
  ASSERT_TRUE(coarse && fine);
  const Points& x = sheet.control_points();
  const PotentialState a = evaluate(*coarse, x, {&tool, 1}), b = evaluate(*fine, x, {&tool, 1});
  EXPECT_LE((a.force - b.force).norm(), 0.02 * b.force.norm());
  EXPECT_LE(100 * a.visited, b.visited);
}

TEST(ToolLoad, SamplesALargeToolBesideASmallOneAsIfItWereAlone) {
  const Surface sheet = testing::uniform_sheet(3, 6, 6);
  const auto alone = ToolLoad<2>::create(sheet, raw, 0.2),
             beside = ToolLoad<2>::create(sheet, raw, 0.01);
  ASSERT_TRUE(alone && beside);
  const ModelTool ball({"ball", testing::sphere_at(Point(0.5, 0.5, 0.15), 0.2)}, Point::Zero(), 1);
  const Penetration a = alone->deepest_entry(sheet.control_points(), 0, ball),
                    b = beside->deepest_entry(sheet.control_points(), 0, ball);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.visited, b.visited);
  EXPECT_NEAR(a.depth, 0.05, 1e-9);
}

}  // namespace
}  // namespace knead
