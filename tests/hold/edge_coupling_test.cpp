// Patches that stay together along curves, whatever their nets.

#include "hold/edge_coupling.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "knead/hold/seams.hpp"
#include "knead/spline/evaluate.hpp"
#include "solve/constraint_space.hpp"

namespace knead {
namespace {

Surface sheet_from(int columns, double x0) {
  const auto u = KnotVector::clamped_uniform(3, 7), v = KnotVector::clamped_uniform(3, columns);
  Points points(7 * columns, 3);
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < columns; ++j)
      points.row(i * columns + j) << x0 + u->greville(i), v->greville(j), 0;
  }
  return *Surface::create({*u, *v}, points);
}

struct Pair {
  Surface a, b;
  std::vector<const Surface*> patches = {&a, &b};
  std::vector<int> rows = {0, a.size(), a.size() + b.size()};
};

/// The curve u = 1 of one patch and u = 0 of the other, or one that runs askew through both.
CoupledEdge edge(int count, bool inside, double noise = 0) {
  CoupledEdge result{"edge", {}};
  for (int k = 0; k <= count; ++k) {
    const double t = static_cast<double>(k) / count, off = k % 2 == 0 ? noise : -noise;
    const double v = std::clamp(t + off, 0.0, 1.0);
    if (inside) {
      result.points.push_back({{0, {0.7 + 0.1 * t, t}}, {1, {0.2 + 0.15 * t, 0.1 + 0.8 * v}}});
    } else {
      result.points.push_back({{0, {1, t}}, {1, {0, v}}});
    }
  }
  return result;
}

int free_count(const Pair& pair, const EdgeCoupling& coupling) {
  return ConstraintSpace::create(pair.rows.back(), coupling.constraints)->free_count();
}

/// The largest distance between both patches along a curve, in displacements of at most 1 that obey
/// the conditions.
double largest_parting(const Pair& pair, const EdgeCoupling& coupling, const CoupledEdge& along) {
  const auto space = ConstraintSpace::create(pair.rows.back(), coupling.constraints);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  double largest = 0;
  for (int k = 0; k < 20; ++k) {
    const Points y = Points::NullaryExpr(space->free_count(), 3, [&] { return number(random); });
    const Points feasible = space->expand_points(y);
    const Points x = feasible / feasible.rowwise().norm().maxCoeff();
    const auto a = pair.a.with_control_points(x.topRows(pair.a.size()));
    const auto b = pair.b.with_control_points(x.bottomRows(pair.b.size()));
    for (const SharedPoint& p : along.points) {
      const Point apart = *evaluate_point<2>(*a, p[0].second) - *evaluate_point<2>(*b, p[1].second);
      largest = std::max(largest, apart.cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

/// A curve that is the same in space for both sheets, the second from x = 1 on, or from 0.5 on if
/// it runs inside; with directions that are one vector there, that of x.
CoupledEdge smooth_edge(int count, bool inside) {
  CoupledEdge result = edge(count, inside);
  for (SharedPoint& point : result.points) {
    const auto [u, v] = point[0].second;
    point[1].second = {inside ? u - 0.5 : 0, v};
  }
  result.across.assign(result.points.size(), {{1, 0}, {1, 0}});
  return result;
}

/// The largest angle between normals at the points of the curve, and the largest turn of a normal,
/// in feasible displacements by up to 0.3, along all axes, of sheets that lie in one plane.
std::array<double, 2> largest_kink(const Pair& pair, const EdgeCoupling& coupling,
                                   const CoupledEdge& along) {
  const auto space = ConstraintSpace::create(pair.rows.back(), coupling.constraints);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(-1, 1);
  std::array<double, 2> largest = {0, 0};
  for (int k = 0; k < 20; ++k) {
    const Points y = Points::NullaryExpr(space->free_count(), 3, [&] { return number(random); });
    const Points feasible = space->expand_points(y);
    const Points x = 0.3 * feasible / feasible.rowwise().norm().maxCoeff();
    const auto normal = [&](const Surface& s, Eigen::Index first, const std::array<double, 2>& at) {
      const auto moved = s.with_control_points(s.control_points() + x.middleRows(first, s.size()));
      Parameters<2> u(1, 2);
      u << at[0], at[1];
      const auto jet = evaluate<2>(*moved, u, 1);
      return Point(Point(jet->at({1, 0}).row(0)).cross(Point(jet->at({0, 1}).row(0))).normalized());
    };
    for (const SharedPoint& p : along.points) {
      const Point a = normal(pair.a, 0, p[0].second),
                  b = normal(pair.b, pair.a.size(), p[1].second);
      largest[0] = std::max(largest[0], std::atan2(a.cross(b).norm(), a.dot(b)));
      largest[1] = std::max(largest[1], std::acos(std::clamp(a.z(), -1.0, 1.0)));
    }
  }
  return largest;
}

TEST(EdgeCoupling, DerivativesThatAgreeKeepTangentPlanesCommonInLargeDisplacements) {
  const Pair equal{sheet_from(9, 0), sheet_from(9, 1)}, other{sheet_from(17, 0), sheet_from(21, 1)},
      over{sheet_from(17, 0), sheet_from(21, 0.5)};
  for (const auto& [pair, inside] : {std::pair{&equal, false}, {&other, false}, {&over, true}}) {
    const CoupledEdge along = smooth_edge(inside ? 320 : 160, inside);
    const auto coupling =
        couple_edges(pair->patches, pair->rows, std::array{along}, {}, {}, {1e-8, 1e-8});
    ASSERT_TRUE(coupling) << coupling.error().message();
    const auto [kink, turn] = largest_kink(*pair, *coupling, along);
    EXPECT_LE(kink, 1e-5);
    EXPECT_GE(turn, 0.1);
    // Without them they do not agree.
    CoupledEdge sharp = along;
    sharp.across.clear();
    const auto position =
        couple_edges(pair->patches, pair->rows, std::array{sharp}, {}, {}, {1e-8, 1e-8});
    EXPECT_GE(largest_kink(*pair, *position, along)[0], 0.1);
    if (pair == &equal) {
      EXPECT_EQ(free_count(*pair, *coupling), pair->rows.back() - 18);
    }
  }
}

TEST(EdgeCoupling, EqualNetsLoseNothingByRoundingInTheParameters) {
  const Pair pair{sheet_from(9, 0), sheet_from(9, 1)};
  for (const double noise : {0.0, 1e-10, 1e-8}) {
    const auto coupling =
        couple_edges(pair.patches, pair.rows, std::array{edge(64, false, noise)}, {}, {}, {1e-6});
    ASSERT_TRUE(coupling) << coupling.error().message();
    EXPECT_EQ(free_count(pair, *coupling), pair.rows.back() - 9) << noise;
    EXPECT_LE(largest_parting(pair, *coupling, edge(200, false)), 1e-5);
  }
}

TEST(EdgeCoupling, WhatSeamsKeepTogetherGetsNoConditions) {
  const Pair pair{sheet_from(9, 0), sheet_from(9, 1)};
  const auto found = find_seams(pair.patches, 1e-3);
  ASSERT_TRUE(found);
  const auto seams = couple_seams(pair.patches, pair.rows, found->seams);
  ASSERT_TRUE(seams);
  ASSERT_FALSE(seams->constraints.empty());
  const auto coupling = couple_edges(pair.patches, pair.rows, std::array{edge(64, false, 1e-9)},
                                     seams->constraints, {}, {1e-6});
  ASSERT_TRUE(coupling);
  EXPECT_TRUE(coupling->constraints.empty());
}

TEST(EdgeCoupling, OtherNetsPartByNoMoreThanTheToleranceAndKeepSomeFreedom) {
  const Pair pair{sheet_from(17, 0), sheet_from(21, 1)};
  for (const bool inside : {false, true}) {
    int before = 0;
    for (const double tolerance : {1e-6, 1e-3, 1e-2, 0.1}) {
      const auto coupling =
          couple_edges(pair.patches, pair.rows, std::array{edge(160, inside)}, {}, {}, {tolerance});
      ASSERT_TRUE(coupling) << coupling.error().message();
      EXPECT_LE(coupling->bound, tolerance);
      EXPECT_LE(largest_parting(pair, *coupling, edge(160, inside)), coupling->bound + 1e-13);
      EXPECT_GE(free_count(pair, *coupling), before);
      before = free_count(pair, *coupling);
    }
    EXPECT_GE(before,
              pair.rows.back() - 25);  // with 17 or 21 functions along the curve on either side
  }
}

TEST(EdgeCoupling, HeldControlPointsStay) {
  const Pair pair{sheet_from(9, 0), sheet_from(9, 1)};
  std::vector<bool> held(static_cast<std::size_t>(pair.rows.back()), false);
  std::fill_n(held.begin(), pair.a.size(), true);
  const auto coupling =
      couple_edges(pair.patches, pair.rows, std::array{edge(64, false)}, {}, held, {1e-6});
  ASSERT_TRUE(coupling);
  EXPECT_EQ(ConstraintSpace::create(pair.rows.back(), coupling->constraints, held)->free_count(),
            pair.b.size() - 9);
}

/// Sheets side by side in a row, each with other knots than the one before.
struct Row {
  std::vector<Surface> sheets;
  std::vector<const Surface*> patches;
  std::vector<int> rows = {0};
  std::vector<CoupledEdge> edges;

  explicit Row(int count) {
    for (int k = 0; k < count; ++k) sheets.push_back(sheet_from(9 + k % 3, k));
    for (const Surface& sheet : sheets) {
      patches.push_back(&sheet);
      rows.push_back(rows.back() + sheet.size());
    }
    for (int k = 0; k + 1 < count; ++k) {
      CoupledEdge along = edge(64, false);
      along.name = "edge " + std::to_string(k);
      for (SharedPoint& point : along.points) {
        for (auto& [patch, at] : point) patch += k;
      }
      edges.push_back(std::move(along));
    }
  }
};

TEST(EdgeCoupling, EdgesTogetherGiveTheConditionsOfOneAfterAnother) {
  const Row row(4);
  const auto together = couple_edges(row.patches, row.rows, row.edges, {}, {}, {1e-3});
  ASSERT_TRUE(together);
  std::vector<LinearConstraint> before;
  for (const CoupledEdge& along : row.edges) {
    const auto next = couple_edges(row.patches, row.rows, std::array{along}, before, {}, {1e-3});
    ASSERT_TRUE(next);
    before.insert(before.end(), next->constraints.begin(), next->constraints.end());
  }
  EXPECT_FALSE(before.empty());
  EXPECT_EQ(together->constraints, before);
}

/// What an edge adds depends on its own sheets, not on how many edges there are.
TEST(EdgeCoupling, TermsOfTheEliminationGrowLinearlyWithTheEdges) {
  const auto terms = [](int count) {
    const Row row(count);
    const auto coupling = couple_edges(row.patches, row.rows, row.edges, {}, {}, {1e-3});
    const auto space = ConstraintSpace::create(row.rows.back(), coupling->constraints);
    std::vector<int> all(static_cast<std::size_t>(row.rows.back()));
    std::iota(all.begin(), all.end(), 0);
    return static_cast<double>(space->terms(all).size()) / count;
  };
  EXPECT_NEAR(terms(40), terms(10), 0.1 * terms(10));
}

/// As beside a sliver, none of whose points has a tangent plane, or no points were found at all.
TEST(EdgeCoupling, EdgeWithoutConditionsCouplesNothing) {
  const Pair pair{sheet_from(9, 0), sheet_from(9, 1)};
  const CoupledEdge without_points{"edge", {}, {{}}};
  CoupledEdge without_planes = edge(8, false);
  without_planes.across.assign(without_planes.points.size(), {});
  const auto none =
      couple_edges(pair.patches, pair.rows, std::array{without_points}, {}, {}, {1e-6});
  ASSERT_TRUE(none) << none.error().message();
  EXPECT_TRUE(none->constraints.empty());
  EXPECT_EQ(none->bound, 0);
  const auto sharp =
      couple_edges(pair.patches, pair.rows, std::array{edge(8, false)}, {}, {}, {1e-6});
  const auto plain =
      couple_edges(pair.patches, pair.rows, std::array{without_planes}, {}, {}, {1e-6});
  ASSERT_TRUE(sharp && plain);
  EXPECT_EQ(free_count(pair, *plain), free_count(pair, *sharp));
}

TEST(EdgeCoupling, EdgeBetweenHeldPatchesCouplesNothing) {
  const Pair pair{sheet_from(9, 0), sheet_from(9, 1)};
  const std::vector<bool> held(static_cast<std::size_t>(pair.rows.back()), true);
  const auto coupling =
      couple_edges(pair.patches, pair.rows, std::array{edge(8, false)}, {}, held, {1e-6});
  ASSERT_TRUE(coupling) << coupling.error().message();
  EXPECT_TRUE(coupling->constraints.empty());
}

TEST(EdgeCoupling, WhatCannotBeIsAnError) {
  const Pair pair{sheet_from(9, 0), sheet_from(9, 1)};
  EXPECT_FALSE(couple_edges(pair.patches, pair.rows, std::array{edge(8, false)}, {}, {}, {0}));
  EXPECT_FALSE(
      couple_edges(pair.patches, pair.rows, std::array{smooth_edge(8, false)}, {}, {}, {1e-6, 2}));
  CoupledEdge outside = edge(8, false);
  outside.points[3][1].second[1] = 1.5;
  const auto refused = couple_edges(pair.patches, pair.rows, std::array{outside}, {}, {}, {1e-6});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message().find("edge"), std::string::npos);
}

}  // namespace
}  // namespace knead
