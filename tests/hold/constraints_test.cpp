#include "knead/hold/constraints.hpp"

#include <gtest/gtest.h>

#include "hold/constrained.hpp"

namespace knead {
namespace {

using namespace testing;

constexpr std::array edges = {SurfaceEdge::u0, SurfaceEdge::u1, SurfaceEdge::v0, SurfaceEdge::v1};

double end_of(const Surface& s, SurfaceEdge edge) {
  const Interval domain = s.knots(edge_across(edge)).domain();
  return edge_at_end(edge) ? domain.upper : domain.lower;
}

/// Σ |R^(k) X| is what rounding of the derivative is relative to: the sizes of basis derivatives
/// and weights there.
double derivative_scale(const Surface& s, SurfaceEdge edge, int order) {
  const KnotVector& knots = s.knots(edge_across(edge));
  const auto span = edge_at_end(edge) ? knots.find_span(knots.domain().upper, Side::left)
                                      : knots.find_span(knots.domain().lower);
  std::vector<double> n(static_cast<std::size_t>((order + 1) * (knots.degree() + 1)));
  basis_derivatives(knots, span, end_of(s, edge), order, n.data());
  double sum = 0;
  for (int r = 0; r <= knots.degree(); ++r)
    sum += std::abs(n[static_cast<std::size_t>(order * (knots.degree() + 1) + r)]);
  return sum;
}

TEST(HoldEdge, KeepsPositionOnEveryKindOfSurfaceHoweverWildTheWeights) {
  for (const auto& [p, q] : {std::pair{1, 2}, {2, 3}, {3, 1}, {4, 3}, {3, 5}}) {
    for (const auto& [name, s] : reliefs(p, q, true, 1e6)) {
      for (const SurfaceEdge edge : edges) {
        ConstraintList list(s.size());
        ASSERT_TRUE(hold_edge(s, edge, 0, list));
        const Points x = random_member(s, list, 7);
        const double most = on_line(field(s, x), edge_across(edge), end_of(s, edge), 0, Side::right)
                                .cwiseAbs()
                                .maxCoeff();
        EXPECT_LT(most, 1e-12) << name << ", " << edge_name(edge);
      }
    }
  }
}

TEST(HoldEdge, KeepsTangentPlanesAndCurvatures) {
  for (const auto& [p, q] : {std::pair{1, 2}, {2, 2}, {3, 4}, {5, 3}}) {
    for (const auto& [name, s] : reliefs(p, q, false, 3)) {
      for (const SurfaceEdge edge : edges) {
        for (int order = 1; order <= 2; ++order) {
          ConstraintList list(s.size());
          ASSERT_TRUE(hold_edge(s, edge, order, list));
          const Points x = random_member(s, list, 8);
          for (int k = 0; k <= order; ++k) {
            const double most =
                on_line(field(s, x), edge_across(edge), end_of(s, edge), k, Side::right)
                    .cwiseAbs()
                    .maxCoeff();
            EXPECT_LT(most, 1e-11 * derivative_scale(
                                        s, edge, std::min(k, s.knots(edge_across(edge)).degree())))
                << name << ", " << edge_name(edge) << ", derivative " << k << " of " << order;
          }
        }
      }
    }
  }
}

TEST(HoldEdge, OfAClampedNetIsHeldRowsThatKeepTheirBits) {
  const Surface s = relief(uniform_clamped(3, 4), uniform_clamped(2, 5), 1, 0.1, 10);
  const auto [m, n] = s.net();
  for (int order = 0; order <= 2; ++order) {
    ConstraintList list(s.size());
    ASSERT_TRUE(hold_edge(s, SurfaceEdge::u1, order, list));
    EXPECT_TRUE(list.constraints.empty());
    for (int i = 0; i < s.size(); ++i) {
      EXPECT_EQ(list.held[static_cast<std::size_t>(i)], i / n >= m - 1 - order);
      if (i / n >= m - 1 - order) {
        EXPECT_EQ(list.held_by[static_cast<std::size_t>(i)], "edge u1");
      }
    }
  }
}

TEST(HoldEdge, TakesNoFreedomThatItNeedNot) {
  // Every row of an unclamped net still moves: order + 1 conditions for each column, and no more.
  const Surface s = relief(uniform_unclamped(3, 5), uniform_clamped(3, 3), 2, 0.1, 4);
  for (int order = 0; order <= 2; ++order) {
    ConstraintList list(s.size());
    ASSERT_TRUE(hold_edge(s, SurfaceEdge::u0, order, list));
    EXPECT_EQ(space_of(s, list).free_count(), s.size() - (order + 1) * s.net()[1]);
  }
}

TEST(HoldIsoline, KeepsTheLineFromBothSides) {
  for (const auto& [p, q] : {std::pair{2, 3}, {3, 2}}) {
    for (const auto& [name, s] : reliefs(p, q, false, 100)) {
      for (int d = 0; d < 2; ++d) {
        const KnotVector& knots = s.knots(d);
        std::vector<double> lines = {std::lerp(knots.domain().lower, knots.domain().upper, 0.37)};
        for (const int span : knots.spans()) lines.push_back(knots[span]);
        for (const double c : lines) {
          ConstraintList list(s.size());
          ASSERT_TRUE(hold_isoline(s, d, c, 0, list));
          const Surface f = field(s, random_member(s, list, 9));
          EXPECT_LT(on_line(f, d, c, 0, Side::left).cwiseAbs().maxCoeff(), 1e-12)
              << name << " at " << c;
          EXPECT_LT(on_line(f, d, c, 0, Side::right).cwiseAbs().maxCoeff(), 1e-12)
              << name << " at " << c;
        }
      }
    }
  }
}

TEST(PinPoint, PutsTheSurfacePointWhereItIsAskedTo) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (const auto& [name, s] : reliefs(3, 2, true, 1e4)) {
    const Interval u = s.knots(0).domain(), v = s.knots(1).domain();
    for (const bool at_corner : {false, true}) {
      Parameters<2> at(1, 2);
      at << (at_corner ? u.upper : std::lerp(u.lower, u.upper, share(random))),
          (at_corner ? v.lower : std::lerp(v.lower, v.upper, share(random)));
      const Point rest = evaluate(s, at)->points().row(0);
      for (const std::optional<Point>& place :
           {std::optional<Point>(), std::optional(Point(0.3, -0.2, 0.7))}) {
        ConstraintList list(s.size());
        ASSERT_TRUE(pin_point(s, at(0, 0), at(0, 1), place, list));
        const Point now = evaluate(moved(s, random_member(s, list, 4)), at)->points().row(0);
        EXPECT_LT((now - place.value_or(rest)).norm(), 1e-10) << name;
      }
    }
  }
}

TEST(PinPoint, WhereItIsAlreadyAsksForNothing) {
  const Surface s = relief(uniform_clamped(3, 4), uniform_clamped(3, 4), 5);
  ConstraintList list(s.size());
  const Point corner = s.control_points().row(0);
  ASSERT_TRUE(pin_point(s, 0, 0, corner, list));
  EXPECT_EQ(list.constraints.front().value, Point::Zero());
}

TEST(FreezeRegion, NoPointOfItMovesAndTheRestDoes) {
  for (const auto& [name, s] : reliefs(3, 2, true, 1e3)) {
    const Interval u = s.knots(0).domain(), v = s.knots(1).domain();
    ConstraintList list(s.size());
    const Interval a{std::lerp(u.lower, u.upper, 0.3), std::lerp(u.lower, u.upper, 0.45)};
    const Interval b{v.lower, std::lerp(v.lower, v.upper, 0.2)};
    const auto region = freeze_region(s, a, b, list);
    ASSERT_TRUE(region) << region.error().message();
    EXPECT_LE(region->u.lower, a.lower);
    EXPECT_GE(region->u.upper, a.upper);
    EXPECT_EQ(region->v.lower, b.lower);
    EXPECT_GE(region->v.upper, b.upper);
    const Surface after = moved(s, random_member(s, list, 6));
    Parameters<2> at(121, 2);
    for (int k = 0; k < 121; ++k) {  // the open region: at its ends the other side may be torn off
      at.row(k) << std::lerp(region->u.lower, region->u.upper, (k / 11 + 0.5) / 11),
          std::lerp(region->v.lower, region->v.upper, (k % 11 + 0.5) / 11);
    }
    EXPECT_EQ(evaluate(after, at)->points(), evaluate(s, at)->points()) << name;
    const auto held = std::ranges::count(list.held, true);
    EXPECT_LE(held, (s.net()[0]) * (s.net()[1]));
  }
  const Surface s = relief(uniform_clamped(3, 8), uniform_clamped(2, 8), 5);
  ConstraintList list(s.size());
  ASSERT_TRUE(
      freeze_region(s, {2, 3}, {3.5, 4.5}, list));  // knots are taken as they are: one span by two
  EXPECT_EQ(std::ranges::count(list.held, true), 4 * 4);
}

TEST(Constraints, OfAllKindsTogetherHold) {
  for (const double spread : {1.0, 10.0}) {
    const Surface s = relief(clamped_knots(3, {0, 1, 2, 3, 4, 5}, {4, 1, 3, 1, 2, 4}),
                             uniform_unclamped(3, 7), 11, 0.1, spread);
    ConstraintList list(s.size());
    ASSERT_TRUE(hold_edge(s, SurfaceEdge::u0, 2, list));
    ASSERT_TRUE(hold_edge(s, SurfaceEdge::v1, 1, list));
    ASSERT_TRUE(hold_edge(s, SurfaceEdge::v1, 0, list));  // said twice
    ASSERT_TRUE(hold_isoline(s, 1, 5.5, 0, list));
    ASSERT_TRUE(pin_point(s, 3.3, 8.1, Point(0.5, 0.5, 0.5), list));
    ASSERT_TRUE(pin_point(s, 0, 6, {}, list));      // on the held edge: follows already
    ASSERT_TRUE(pin_point(s, 4.2, 5.5, {}, list));  // on the kept line
    ASSERT_TRUE(freeze_region(s, {4.5, 5}, {3, 3.2}, list));
    ASSERT_TRUE(keep_smooth(s, {}, list));
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const Points x = random_member(s, list, seed);
      const Surface f = field(s, x);
      for (int k = 0; k <= 2; ++k)
        EXPECT_LT(on_line(f, 0, 0, k, Side::right).cwiseAbs().maxCoeff(), 1e-10);
      for (int k = 0; k <= 1; ++k)
        EXPECT_LT(on_line(f, 1, 10, k, Side::right).cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_LT(on_line(f, 1, 5.5, 0, Side::right).cwiseAbs().maxCoeff(), 1e-10);
      Parameters<2> at(1, 2);
      at << 3.3, 8.1;
      EXPECT_LT(
          (evaluate(moved(s, x), at)->points().row(0).transpose() - Point(0.5, 0.5, 0.5)).norm(),
          1e-10);
    }
  }
}

TEST(Constraints, HoldOnRandomSurfaces) {
  std::mt19937_64 random(2024);
  std::uniform_real_distribution<double> share(0, 1);
  for (int round = 0; round < 200; ++round) {
    const int p = 1 + round % 6, q = 1 + (round / 6) % 5;
    const KnotVector u = random_knots(random, p), v = random_knots(random, q);
    const Surface s = relief(u, v, static_cast<unsigned>(round), 0.1, round % 2 == 0 ? 1 : 100);
    const auto inside = [&](const Interval& i) {
      return std::clamp(i.lower + share(random) * i.length(), i.lower, i.upper);
    };
    const double c = inside(u.domain());
    ConstraintList list(s.size());
    ASSERT_TRUE(hold_isoline(s, 0, c, 0, list));
    ASSERT_TRUE(hold_edge(s, SurfaceEdge::v0, 0, list));
    Parameters<2> at(1, 2);
    at << inside(u.domain()), inside(v.domain());
    ASSERT_TRUE(pin_point(s, at(0, 0), at(0, 1), {}, list));
    const Surface f = field(s, random_member(s, list, static_cast<unsigned>(round)));
    EXPECT_LT(on_line(f, 0, c, 0, Side::right).cwiseAbs().maxCoeff(), 1e-10) << "round " << round;
    EXPECT_LT(on_line(f, 1, v.domain().lower, 0, Side::right).cwiseAbs().maxCoeff(), 1e-10)
        << "round " << round;
    EXPECT_LT(evaluate(f, at)->points().norm(), 1e-10) << "round " << round;
  }
}

TEST(Constraints, ThatContradictAreNamed) {
  const Surface s = relief(uniform_clamped(3, 4), uniform_unclamped(3, 4), 12);
  const Points none = Points::Zero(s.size(), 3);
  const auto message = [&](const ConstraintList& list) {
    const auto space = constraint_space(list, none, size_of(s));
    return space ? std::string("none") : space.error().message();
  };
  ConstraintList twice(s.size());
  ASSERT_TRUE(pin_point(s, 1.5, 4.5, Point(0, 0, 1), twice));
  ASSERT_TRUE(pin_point(s, 1.5, 4.5, Point(0, 0, 2), twice));
  EXPECT_NE(message(twice).find("pin at (1.5, 4.5) to (0, 0, 2): the constraint contradicts pin at "
                                "(1.5, 4.5) to (0, 0, 1)"),
            std::string::npos)
      << message(twice);
  ConstraintList frozen(s.size());
  ASSERT_TRUE(freeze_region(s, {1, 2}, {4, 5}, frozen));
  ASSERT_TRUE(pin_point(s, 1.5, 4.5, {}, frozen));
  EXPECT_EQ(message(frozen), "none");
  ASSERT_TRUE(pin_point(s, 1.5, 4.5, Point(0, 0, 1), frozen));
  EXPECT_NE(
      message(frozen).find("to (0, 0, 1): the constraint contradicts frozen [1, 2] x [4, 5] by"),
      std::string::npos)
      << message(frozen);
  ConstraintList edge(s.size());
  ASSERT_TRUE(hold_edge(s, SurfaceEdge::v0, 0, edge));
  ASSERT_TRUE(pin_point(s, 2.25, 3, Point(0, 0, 1), edge));
  EXPECT_NE(message(edge).find("the constraint contradicts edge v0"), std::string::npos)
      << message(edge);
}

TEST(Constraints, HoldThePresentWhenAsked) {
  const Surface s = relief(uniform_unclamped(3, 4), uniform_clamped(3, 4), 13, 0.1, 5);
  const Points present = 0.1 * random_points(s.size(), 14);
  ConstraintList list(s.size());
  ASSERT_TRUE(hold_edge(s, SurfaceEdge::u0, 1, list));
  ASSERT_TRUE(pin_point(s, 5.5, 1.5, {}, list));
  keep_present(list, present);
  const auto space = constraint_space(list, present, 1);
  ASSERT_TRUE(space);
  EXPECT_LT((space->feasible(present) - present).cwiseAbs().maxCoeff(), 1e-14);
  const Points x = space->feasible(random_points(s.size(), 15));
  for (int k = 0; k <= 1; ++k) {
    EXPECT_LT((on_line(field(s, x), 0, 3, k, Side::right) -
               on_line(field(s, present), 0, 3, k, Side::right))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-12);
  }
}

TEST(Constraints, RefuseWhatIsNoPlaceOnTheSurface) {
  const Surface s = uniform_sheet(3, 6, 6);
  ConstraintList list(s.size());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(hold_edge(s, SurfaceEdge::u0, 3, list));
  EXPECT_FALSE(hold_edge(s, SurfaceEdge::u0, -1, list));
  EXPECT_FALSE(hold_isoline(s, 0, 1.5, 0, list));
  EXPECT_FALSE(hold_isoline(s, 0, nan, 0, list));
  EXPECT_FALSE(pin_point(s, 0.5, -1e-9, {}, list));
  EXPECT_FALSE(pin_point(s, 0.5, 0.5, Point(0, 0, nan), list));
  EXPECT_FALSE(freeze_region(s, {0.5, 0.4}, {0, 1}, list));
  EXPECT_FALSE(freeze_region(s, {0.5, 2}, {0, 1}, list));
  EXPECT_FALSE(keep_smooth(s, {nan, 0, 0}, list));
  EXPECT_FALSE(keep_poles(s, -1, 0, list));
  EXPECT_TRUE(list.constraints.empty());
  EXPECT_EQ(std::ranges::count(list.held, true), 0);
}

}  // namespace
}  // namespace knead
