// The visible part of a surface on a grid, and what tools press there.

#include "brep/visible_mask.hpp"

#include <chrono>
#include <numbers>

#include "support/surfaces.hpp"
#include "support/tools.hpp"
#include "tool/tool_load.hpp"

namespace knead {
namespace {

using Eigen::Vector2d;
using Loop = std::vector<Vector2d>;

/// A circle as a polygon of the same area.
Loop circle(const Vector2d& centre, double radius, int corners) {
  const double angle = 2 * std::numbers::pi / corners;
  const double outer = radius * std::sqrt(angle / std::sin(angle));
  Loop loop;
  for (int k = 0; k < corners; ++k) {
    loop.push_back(centre + outer * Vector2d(std::cos(k * angle), std::sin(k * angle)));
  }
  return loop;
}

VisibleRegion region(std::vector<Loop> face) {
  VisibleRegion result;
  result.faces = {std::move(face)};
  return result;
}

std::vector<double> even_lines(int count) {
  std::vector<double> lines;
  for (int k = 0; k <= count; ++k) lines.push_back(k / static_cast<double>(count));
  return lines;
}

/// The visible area of a cell, and its first moments.
std::array<double, 3> moments(const VisibleMask& mask,
                              const std::array<std::vector<double>, 2>& lines, int i, int j) {
  const auto &xs = lines[0], &ys = lines[1];
  const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
  const double area = (xs[a + 1] - xs[a]) * (ys[b + 1] - ys[b]);
  const int state = mask.state(i, j);
  if (state == VisibleMask::hidden) return {0, 0, 0};
  if (state == VisibleMask::full)
    return {area, area * (xs[a] + xs[a + 1]) / 2, area * (ys[b] + ys[b + 1]) / 2};
  const auto& part = mask.cut_cells()[static_cast<std::size_t>(state)];
  return {part.share * area, part.share * area * part.middle[0],
          part.share * area * part.middle[1]};
}

std::array<double, 3> total(const VisibleMask& mask,
                            const std::array<std::vector<double>, 2>& lines) {
  std::array<double, 3> sum = {};
  for (int i = 0; i + 1 < static_cast<int>(lines[0].size()); ++i) {
    for (int j = 0; j + 1 < static_cast<int>(lines[1].size()); ++j) {
      const auto m = moments(mask, lines, i, j);
      for (std::size_t k = 0; k < 3; ++k) sum[k] += m[k];
    }
  }
  return sum;
}

TEST(VisibleMask, HasTheAreaAndTheCentroidOfAPolygon) {
  // Corners outside the domain, a side on a line of the grid, a hole, and loops in either sense.
  const Loop triangle = {{0.1, -0.3}, {1.2, 0.5}, {0.1, 0.9}},
             hole = {{0.2, 0.3}, {0.4, 0.3}, {0.4, 0.5}, {0.2, 0.5}};
  const Loop reversed(hole.rbegin(), hole.rend());
  // By hand: the triangle's part with y >= 0 and x <= 1.
  const auto upper = [](double x) { return 0.9 - (x - 0.1) * 0.4 / 1.1; };
  const auto lower = [](double x) { return std::max(0., -0.3 + (x - 0.1) * 0.8 / 1.1); };
  const double kink = 0.1 + 0.3 * 1.1 / 0.8;
  const double area = (kink - 0.1) * (upper(0.1) + upper(kink)) / 2 +
                      (1 - kink) * (upper(kink) + upper(1) - lower(1)) / 2;
  for (const Loop& inner : {hole, reversed}) {
    for (const int count : {1, 5, 10, 37}) {
      const std::array<std::vector<double>, 2> lines = {even_lines(count), even_lines(count + 3)};
      const auto sum = total(VisibleMask(region({triangle, inner}), lines), lines);
      EXPECT_NEAR(sum[0], area - 0.04, 1e-8)
          << count;  // cells are whole or hidden to 1e-9 of theirs
      const auto whole = total(VisibleMask(region({triangle}), lines), lines);
      EXPECT_NEAR(whole[1] - sum[1], 0.04 * 0.3, 1e-8) << count;
      EXPECT_NEAR(whole[2] - sum[2], 0.04 * 0.4, 1e-8) << count;
    }
  }
}

TEST(VisibleMask, OfShortSpansBesideLongOnesIsAsExact) {
  // A cluster of spans of 1e-9 on a slanted edge.
  std::array<std::vector<double>, 2> lines;
  lines[0] = {0, 0.3, 0.3 + 1e-9, 0.3 + 2e-9, 0.3 + 3e-9, 1};
  lines[1] = {0, 0.45, 0.5 - 1e-9, 0.5, 0.5 + 1e-9, 0.5 + 2e-9, 1};
  // Above y = 0.5 + (x − 0.3) / 2.
  const Loop above = {{-1, -0.15}, {1.5, 1.1}, {1.5, 2}, {-1, 2}};
  const VisibleMask mask(region({above}), lines);
  for (int i = 1; i < 4; ++i) {
    const double middle = lines[0][static_cast<std::size_t>(i)] - 0.3 + 0.5e-9,
                 edge = 0.5 + middle / 2;
    for (int j = 1; j < 5; ++j) {
      const double y0 = lines[1][static_cast<std::size_t>(j)],
                   y1 = lines[1][static_cast<std::size_t>(j) + 1];
      if (edge + 0.3e-9 > y1 && edge - 0.3e-9 < y1) continue;
      if (edge + 0.3e-9 > y0 && edge - 0.3e-9 < y0) continue;
      const double share = std::clamp((y1 - edge) / (y1 - y0), 0., 1.);
      EXPECT_NEAR(moments(mask, lines, i, j)[0] / (1e-9 * (y1 - y0)), share, 1e-6) << i << " " << j;
    }
  }
}

TEST(VisibleMask, HasTheVisibleAreaOfEverySpanOfADiscTo1e4OfIt) {
  const Vector2d centre(0.47, 0.52);
  constexpr double radius = 0.31;
  // ∫ over x of what of [y0, y1] lies within the circle.
  const auto exact = [&](double x0, double x1, double y0, double y1) {
    constexpr int steps = 20000;
    double sum = 0;
    for (int k = 0; k < steps; ++k) {
      const double x = x0 + (x1 - x0) * (k + 0.5) / steps - centre.x();
      if (std::abs(x) >= radius) continue;
      const double half = std::sqrt(radius * radius - x * x);
      sum += std::max(0., std::min(y1, centre.y() + half) - std::max(y0, centre.y() - half));
    }
    return sum * (x1 - x0) / steps;
  };
  const std::array<std::vector<double>, 2> lines = {even_lines(9), even_lines(7)};
  const VisibleMask mask(region({circle(centre, radius, 256)}), lines);
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 7; ++j) {
      const double area = exact(i / 9., (i + 1) / 9., j / 7., (j + 1) / 7.);
      EXPECT_NEAR(moments(mask, lines, i, j)[0], area, 1e-4 / 63) << i << " " << j;
    }
  }
}

TEST(VisibleMask, OfSeveralFacesIsTheirUnion) {
  VisibleRegion two = region({{{0, 0}, {0.35, 0}, {0.35, 1}, {0, 1}}});
  two.faces.push_back({{{0.35, 0}, {0.35, 1}, {1, 1}, {1, 0}}});
  const std::array<std::vector<double>, 2> lines = {even_lines(4), even_lines(3)};
  EXPECT_TRUE(VisibleMask(two, lines).whole());
  EXPECT_TRUE(VisibleMask(VisibleRegion{}, lines).whole());
  two.faces.pop_back();
  EXPECT_EQ(VisibleMask(two, lines).state({0, 0}, {1, 3}), VisibleMask::full);
  EXPECT_EQ(VisibleMask(two, lines).state({0, 0}, {2, 3}), VisibleMask::cut);
  EXPECT_EQ(VisibleMask(two, lines).state({2, 0}, {4, 3}), VisibleMask::hidden);
}

/// A sphere so large that a sheet in z = 0 sees a plane: every point enters by the same depth along
/// −z.
Tool flat_tool(ToolTouch touches) {
  Tool tool{"plane", testing::sphere_at(Point(0.5, 0.5, 1e7 - 0.01), 1e7), ToolMode::collision, 3,
            1};
  tool.touches = touches;
  return tool;
}

PotentialState state_of(const ToolLoad<2>& load, const Points& x, const Tool& tool) {
  PotentialState state;
  state.force = Points::Zero(x.rows(), 3);
  const std::vector<ModelTool> model = {{tool, Point::Zero(), 1}};
  load.evaluate(x, 0, 0, {.tools = model}, state);
  if (load.hides()) load.evaluate(x, 0, 0, {.tools = model, .pass = ToolPass::visible}, state);
  return state;
}

TEST(VisibleMask, ToolsPressOnTheVisibleAreaAlone) {
  const KnotVector knots = testing::uniform_clamped(3, 7);
  const Surface s = testing::sheet(knots, knots);
  for (const double detail : {0.05, 0.4, std::numeric_limits<double>::infinity()}) {
    auto load = ToolLoad<2>::create(s, DomainScaling<2>{}, detail);
    ASSERT_TRUE(load);
    const auto whole = state_of(*load, s.control_points(), flat_tool(ToolTouch::all));
    const Vector2d hole(0.45, 0.55);
    const Loop corners = {{0.05, 0}, {1, 0.1}, {0.9, 1}, {0, 0.8}};
    load->show(std::make_shared<const VisibleRegion>(region({corners, circle(hole, 0.2, 400)})));
    const auto visible = state_of(*load, s.control_points(), flat_tool(ToolTouch::visible));
    const auto all = state_of(*load, s.control_points(), flat_tool(ToolTouch::all));
    EXPECT_EQ(all.force, whole.force) << "a tool that touches everything is as without a mask";
    // A force of −k · depth on the area of the polygon without the disc.
    double twice = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector2d &a = corners[k], &b = corners[(k + 1) % 4];
      twice += a.x() * b.y() - b.x() * a.y();
    }
    const double shown = (twice / 2 - std::numbers::pi * 0.04) * 49;  // the domain is 7 by 7
    EXPECT_NEAR(visible.force.col(2).sum(), -0.03 * shown,
                2e-6 * 0.03 * shown);  // the sphere is that far from flat
    for (const ContactPoint& c : visible.contacts) EXPECT_GT(c.factor, 0);
  }
}

TEST(VisibleMask, AToolInAHoleTouchesNothingAndSeesNoEntry) {
  const KnotVector knots = testing::uniform_clamped(3, 7);
  const Surface s = testing::sheet(knots, knots);
  auto load = ToolLoad<2>::create(s, DomainScaling<2>{}, 0.15);
  ASSERT_TRUE(load);
  load->show(std::make_shared<const VisibleRegion>(
      region({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, circle({0.45, 0.55}, 0.2, 400)})));
  // It comes to 0.19 from the middle of the hole, whose edge cuts cells of the grid there.
  Tool ball{"ball", testing::sphere_at(Point(0.45, 0.55, 0), 0.19), ToolMode::collision, 3, 1};
  const ModelTool everywhere(ball, Point::Zero(), 1);
  EXPECT_GT(load->deepest_entry(s.control_points(), 0, everywhere).depth, 0.1);
  ball.touches = ToolTouch::visible;
  const auto state = state_of(*load, s.control_points(), ball);
  EXPECT_EQ(state.force, Points::Zero(s.size(), 3));
  EXPECT_EQ(state.entry, 0);
  EXPECT_LE(load->deepest_entry(s.control_points(), 0, ModelTool(ball, Point::Zero(), 1)).depth, 0);
  // Where it reaches over the edge, it enters no deeper than at the edge.
  ball.shape = testing::sphere_at(Point(0.45, 0.55, 0), 0.23);
  const double entry =
      load->deepest_entry(s.control_points(), 0, ModelTool(ball, Point::Zero(), 1)).depth;
  EXPECT_NEAR(entry, 0.03, 1e-3);
}

TEST(VisibleMask, ForceIsMinusTheGradientOfThePotential) {
  const Surface s = testing::relief(testing::uniform_clamped(2, 3), testing::uniform_clamped(2, 3),
                                    2, 0.1, 5);  // rational
  auto load = ToolLoad<2>::create(s, DomainScaling<2>{1, {0.7, 1.3}}, 0.3);
  ASSERT_TRUE(load);
  load->show(std::make_shared<const VisibleRegion>(region({circle({0.55, 0.5}, 0.23, 100)})));
  Tool tool{"ball", testing::sphere_at(Point(0.6, 0.4, 0.3), 0.35), ToolMode::proximity, 10, 0.3};
  tool.touches = ToolTouch::visible;
  const Points x = s.control_points(), direction = testing::random_points(x.rows(), 4);
  const auto state = state_of(*load, x, tool);
  ASSERT_GT(state.contacts.size(), 10U);
  EXPECT_TRUE(
      std::ranges::any_of(state.contacts, [](const ContactPoint& c) { return c.part >= 0; }));
  constexpr double h = 1e-5;
  const auto up = state_of(*load, x + h * direction, tool),
             down = state_of(*load, x - h * direction, tool);
  const double slope = (up.potential - down.potential) / (2 * h);
  EXPECT_NEAR(-state.force.cwiseProduct(direction).sum(), slope, 1e-4 * std::abs(slope));
  Points curved = Points::Zero(x.rows(), 3);
  load->apply_hessian(state.contacts, 0, direction, curved);
  const Points difference = (down.force - up.force) / (2 * h);
  EXPECT_LE((curved - difference).norm(), 1e-4 * difference.norm());
}

TEST(VisibleMask, IsMadeQuickly) {
  // A face with 20 edges of 128 chords each, on a net of 32 by 32 control points.
  Loop star;
  for (int k = 0; k < 20 * 128; ++k) {
    const double angle = 2 * std::numbers::pi * k / (20 * 128),
                 radius = 0.4 + 0.05 * std::cos(10 * angle);
    star.emplace_back(0.5 + radius * std::cos(angle), 0.5 + radius * std::sin(angle));
  }
  const KnotVector knots = testing::uniform_clamped(3, 29);
  const Surface s = testing::sheet(knots, knots);
  auto load = ToolLoad<2>::create(s, DomainScaling<2>{}, 0.02);
  ASSERT_TRUE(load);
  auto shown = std::make_shared<const VisibleRegion>(region({star}));
  double least = 1;
  for (int k = 0; k < 5; ++k) {
    const auto start = std::chrono::steady_clock::now();
    load->show(shown);
    least = std::min(
        least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::cout << "mask: " << 1e3 * least << " ms\n";
  EXPECT_LT(least, 0.05);
}

}  // namespace
}  // namespace knead
