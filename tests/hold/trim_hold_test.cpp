#include "hold/trim_hold.hpp"

#include <cmath>
#include <numbers>

#include "constrained.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/spline_refinement.hpp"

namespace knead {
namespace {

using Eigen::Vector2d;

Surface sheet(int degree, int count) {
  const auto knots = *KnotVector::clamped_uniform(degree, count, 0, 1);
  Points points(count * count, 3);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j)
      points.row(i * count + j) << knots.greville(i), knots.greville(j), 0;
  }
  return *Surface::create({knots, knots}, points);
}

TrimEdge edge_along(const std::string& id, const std::vector<Vector2d>& course) {
  TrimEdge edge;
  edge.id = id;
  edge.course = course;
  for (const Vector2d& p : course) edge.points.emplace_back(p.x(), p.y(), 0);
  return edge;
}

VisibleRegion disc(double radius = 0.4) {
  std::vector<Vector2d> circle;
  constexpr int steps = 200;
  for (int k = 0; k <= steps; ++k) {
    const double t = 2 * std::numbers::pi * k / steps;
    circle.emplace_back(0.5 + radius * std::cos(t), 0.5 + radius * std::sin(t));
  }
  VisibleRegion region;
  region.edges.push_back(edge_along("#1", circle));
  region.edges[0].deviation = 1e-4;
  circle.pop_back();
  region.faces = {{circle}};
  return region;
}

/// The four sides of the unit square, its whole surface visible.
VisibleRegion whole() {
  VisibleRegion region;
  region.edges = {edge_along("#1", {{0, 0}, {1, 0}}), edge_along("#2", {{1, 0}, {1, 1}}),
                  edge_along("#3", {{1, 1}, {0, 1}}), edge_along("#4", {{0, 1}, {0, 0}})};
  return region;
}

double largest_along(const Surface& displacement, const TrimEdge& edge, int order) {
  double largest = 0;
  for (const Vector2d& at : edge.course) {
    Parameters<2> here(1, 2);
    here << at.x(), at.y();
    const auto jet = evaluate<2>(displacement, here, order);
    for (const auto& index : multi_indices<2>(order))
      largest = std::max(largest, jet->at(index).row(0).norm());
  }
  return largest;
}

TEST(TrimHold, ADisplacementThatIsFreeVanishesOnACircleWithAllItsDerivatives) {
  const VisibleRegion region = disc();
  for (const int degree : {2, 3, 5}) {
    const Surface s = sheet(degree, 30);
    ConstraintList list(s.size());
    const auto held = hold_trims(s, region, std::array{0}, 0, list);
    ASSERT_TRUE(held);
    EXPECT_GT(held->free, 9);
    EXPECT_FALSE(held->edges[0].along_lines);
    const Points x = testing::random_member(s, list, 7);
    EXPECT_GT(x.cwiseAbs().maxCoeff(), 0.5);
    EXPECT_EQ(largest_along(testing::field(s, x), region.edges[0], 2), 0) << degree;
  }
}

TEST(TrimHold, WhatLiesOutsideDoesNotMove) {
  const VisibleRegion region = disc(0.2);
  const Surface s = sheet(3, 40);
  ConstraintList list(s.size());
  ASSERT_TRUE(hold_trims(s, region, std::array{0}, 0, list));
  const Surface d = testing::field(s, testing::random_member(s, list, 3));
  for (const auto& at : {std::array{0.1, 0.1}, {0.5, 0.75}, {0.29, 0.5}, {0.99, 0.4}}) {
    EXPECT_EQ(evaluate_point<2>(d, at)->norm(), 0);
  }
}

TEST(TrimHold, EdgesAtTheEndsOfTheDomainHoldOneRowForEachOrder) {
  const Surface s = sheet(3, 10);
  for (int order = 0; order <= 2; ++order) {
    ConstraintList list(s.size());
    const auto held = hold_trims(s, whole(), std::vector<int>(4, order), 0, list);
    ASSERT_TRUE(held);
    const int inner = 10 - 2 * (order + 1);
    EXPECT_EQ(held->free, inner * inner);
    for (const HeldEdge& edge : held->edges) EXPECT_TRUE(edge.along_lines);
  }
}

TEST(TrimHold, ATangentPlaneIsHeldByOneMoreRowWhereTheEdgeOnlyRunsBesideTheLineOrALineIsAPole) {
  const Surface s = sheet(3, 10);
  for (int order = 0; order <= 1; ++order) {
    VisibleRegion beside = whole(), pole = whole();
    beside.edges[3] = edge_along("#4", {{1e-5, 1}, {1e-5, 0}});
    pole.poles[0][0] = true;
    const int free = 10 * (10 - (order == 0 ? 1 : 3));
    ConstraintList list(s.size());
    const auto held = hold_trims(s, beside, std::array{-1, -1, -1, order}, 1e-4, list);
    ASSERT_TRUE(held);
    EXPECT_TRUE(held->edges[3].along_lines);
    EXPECT_EQ(held->free, free);
    ConstraintList other(s.size());
    const auto at_pole = hold_trims(s, pole, std::array{-1, -1, -1, order}, 0, other);
    ASSERT_TRUE(at_pole);
    EXPECT_EQ(at_pole->free, free);
  }
}

TEST(TrimHold, AFreeEdgeHoldsNothing) {
  const Surface s = sheet(3, 10);
  ConstraintList list(s.size());
  const auto held = hold_trims(s, whole(), std::array{-1, -1, -1, 0}, 0, list);
  ASSERT_TRUE(held);
  EXPECT_EQ(held->free, 90);
  EXPECT_EQ(list.held_by[0], "edge #4");
  EXPECT_EQ(held->edges[0].points, 0);
}

TEST(TrimHold, AnEdgeAlongAKnotLineHoldsBothItsSidesByMultiplicity) {
  // The knot 0.5 three times, degree 3: one row of control points lies on the line.
  const Surface s = *insert_knots<2>(sheet(3, 9), {std::vector<double>{0.5, 0.5}, {}});
  VisibleRegion region = whole();
  region.faces = {{{{0, 0}, {0.5, 0}, {0.5, 1}, {0, 1}}}};
  region.edges = {edge_along("#1", {{0.5, 0}, {0.5, 1}})};
  ASSERT_EQ(s.knots(0).multiplicity(0.5), 3);
  ConstraintList list(s.size());
  const auto held = hold_trims(s, region, std::array{0}, 0, list);
  ASSERT_TRUE(held);
  int row = 0;
  while (s.knots(0)[row + 1] < 0.5 || s.knots(0)[row + 3] > 0.5) ++row;
  // Rows before the line are free, the line's own and those behind it (which are not visible) are
  // held.
  EXPECT_EQ(held->free, row * s.net()[1]);
}

TEST(TrimHold, OrdersAreChecked) {
  const Surface s = sheet(3, 10);
  ConstraintList list(s.size());
  EXPECT_FALSE(hold_trims(s, whole(), std::array{0}, 0, list));
  EXPECT_FALSE(hold_trims(s, whole(), std::array{0, 0, 0, 3}, 0, list));
}

TEST(TrimHold, AnEdgeOverTheSeamOfAClosedSurfaceIsHeldOnBothSides) {
  const Surface s = sheet(3, 12);
  VisibleRegion region;
  region.closed = {true, false};
  region.edges = {edge_along("#1", {{0, 0}, {0, 1}}), edge_along("#2", {{0.9, 0.5}, {1.1, 0.5}})};
  ConstraintList list(s.size());
  ASSERT_TRUE(hold_trims(s, region, std::array{0, 0}, 0, list));
  for (int j = 0; j < 12; ++j) {
    EXPECT_TRUE(list.held[static_cast<std::size_t>(j)]);
    EXPECT_TRUE(list.held[static_cast<std::size_t>(11 * 12 + j)]);
  }
  const Surface d = testing::field(s, testing::random_member(s, list, 5));
  for (const double u : {0.0, 0.05, 0.1, 0.9, 0.95, 1.0}) {
    EXPECT_EQ(evaluate_point<2>(d, {u, 0.5})->norm(), 0) << u;
  }
}

TEST(TrimRefinement, LetsACoarseNetMoveInsideItsTrims) {
  const VisibleRegion region = disc(0.2);
  for (const int degree : {1, 2, 3, 5, 9}) {
    const Surface coarse = sheet(degree, degree + 1);
    const auto refinement =
        trim_refinement(coarse, {0.5, 0.5}, 0.2, 0.1, trim_refinement_cap(coarse));
    ASSERT_TRUE(refinement);
    EXPECT_FALSE(refinement->capped);
    const auto fine = refinement->apply(coarse);
    ASSERT_TRUE(fine);
    EXPECT_LE(largest_distance(coarse, *fine), 1e-14);
    EXPECT_LE(fine->size(), trim_refinement_cap(coarse));
    if (degree == 1) {
      EXPECT_EQ(fine->knots(0).degree(), 3);
    }
    ConstraintList list(fine->size());
    const auto held = hold_trims(*fine, region, std::array{0}, 0, list);
    ASSERT_TRUE(held);
    EXPECT_GE(held->free, 9) << degree;
  }
}

TEST(TrimRefinement, ANetThatIsFineEnoughStays) {
  const Surface fine = sheet(3, 60);
  const auto refinement = trim_refinement(fine, {0.5, 0.5}, 0.4, 0.1, 1 << 20);
  ASSERT_TRUE(refinement);
  EXPECT_TRUE(refinement->empty());
}

TEST(TrimRefinement, KeepsToItsCap) {
  const Surface coarse = sheet(3, 4);
  const auto refinement = trim_refinement(coarse, {0.5, 0.5}, 0.2, 0.01, 150);
  ASSERT_TRUE(refinement);
  EXPECT_TRUE(refinement->capped);
  EXPECT_LE(refinement->apply(coarse)->size(), 150);
}

}  // namespace
}  // namespace knead
