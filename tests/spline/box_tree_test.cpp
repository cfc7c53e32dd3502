#include "spline/box_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

namespace knead {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const auto any = [](const TriangleTree::Hit&) { return true; };

/// The surface z = height over the grid of whole numbers from 0 to n, as two triangles per square.
TriangleTree bumpy(int n) {
  std::vector<Point> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      points.emplace_back(i, j, std::sin(i) + std::cos(2.0 * j));
      if (i == n || j == n) continue;
      const auto k = static_cast<std::uint32_t>(i * (n + 1) + j),
                 next = k + static_cast<std::uint32_t>(n) + 1;
      triangles.push_back({k, next, next + 1});
      triangles.push_back({k, next + 1, k + 1});
    }
  }
  return {points, triangles};
}

TEST(TriangleTree, MeetsEverySharedCornerAndSide) {
  const int n = 17;
  const TriangleTree tree = bumpy(n);
  for (int i = 0; i <= 2 * n; ++i) {
    for (int j = 0; j <= 2 * n; ++j) {  // corners, and midpoints of all sides
      double to = infinity;
      ASSERT_TRUE(tree.nearest({{i / 2.0, j / 2.0, 10}, -Point::UnitZ()}, to, any))
          << i << " " << j;
      if (i % 2 != 0 || j % 2 != 0) continue;
      EXPECT_NEAR(to, 10 - std::sin(i / 2) - std::cos(j), 1e-14);
    }
  }
  double to = infinity;
  EXPECT_FALSE(tree.nearest({{-0.001, 3, 10}, -Point::UnitZ()}, to, any));
  EXPECT_FALSE(tree.nearest({{3, 3, 10}, Point::UnitZ()}, to, any));
  EXPECT_FALSE(TriangleTree().nearest({{3, 3, 10}, Point::UnitZ()}, to, any));
}

TEST(TriangleTree, FindsTheHitThatASearchOfAllTrianglesFinds) {
  const TriangleTree tree = bumpy(8);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-2, 10), turn(-1, 1);
  int hits = 0;
  for (int k = 0; k < 500; ++k) {
    const Ray ray{{place(random), place(random), turn(random)},
                  Point(turn(random), turn(random), turn(random)).normalized()};
    // Each triangle in a tree of its own: no other can hide it.
    double nearest = infinity;
    for (std::uint32_t t = 0; t < tree.triangles().size(); ++t) {
      double alone = infinity;
      if (tree.nearest(ray, alone,
                       [&](const TriangleTree::Hit& hit) { return hit.triangle == t; })) {
        nearest = std::min(nearest, alone);
      }
    }
    double to = infinity;
    EXPECT_EQ(tree.nearest(ray, to, any), std::isfinite(nearest));
    EXPECT_EQ(to, nearest);
    hits += std::isfinite(nearest) ? 1 : 0;
  }
  EXPECT_GT(hits, 50);
}

TEST(TriangleTree, GoesOnWhereAHitDoesNotCount) {
  std::vector<Point> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t k = 0; k < 100; ++k) {  // a stack
    for (const Point& p : {Point(0, 0, k), Point(1, 0, k), Point(0, 1, k)}) points.push_back(p);
    triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  const TriangleTree stack(points, triangles);
  double to = infinity;
  std::optional<TriangleTree::Hit> last;
  ASSERT_TRUE(
      stack.nearest({{0.25, 0.5, -1}, Point::UnitZ()}, to, [&](const TriangleTree::Hit& hit) {
        if (hit.triangle < 61) return false;
        last = hit;
        return true;
      }));
  EXPECT_EQ(to, 62);
  EXPECT_NEAR(last->weights[0], 0.25, 1e-15);
  EXPECT_NEAR(last->weights[1], 0.25, 1e-15);
  EXPECT_NEAR(last->weights[2], 0.5, 1e-15);
  EXPECT_EQ(stack.facet(61), Point(0, 0, 1));
}

}  // namespace
}  // namespace knead
