#include "knead/spline/spline_refinement.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "spline/sample_splines.hpp"

namespace knead {
namespace {

using testing::clamped_knots;
using testing::knot_families;
using testing::make_spline;
using testing::random_spline;

/// The largest distance between both, over a dense grid.
template <int D>
double distance(const Spline<D>& a, const Spline<D>& b) {
  auto grid = testing::grid_of(a);
  const auto x = evaluate_grid<D>(a, testing::spans_of<D>(grid)),
             y = evaluate_grid<D>(b, testing::spans_of<D>(grid));
  if (!x || !y) {
    ADD_FAILURE() << "no evaluation";
    return 1e300;
  }
  return (x->points() - y->points()).rowwise().norm().maxCoeff();
}

/// A smooth surface on given knots: control points on a gentle landscape over the Greville
/// abscissae.
Surface landscape(const std::array<KnotVector, 2>& knots, double roughness = 0) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> noise(-roughness, roughness);
  Points points(knots[0].count() * knots[1].count(), 3);
  for (int i = 0; i < knots[0].count(); ++i) {
    for (int j = 0; j < knots[1].count(); ++j) {
      const double u = knots[0].greville(i), v = knots[1].greville(j);
      points.row(i * knots[1].count() + j) << u, v,
          std::sin(0.4 * u) * std::cos(0.3 * v) + noise(random);
    }
  }
  return make_spline<2>(knots, points);
}

TEST(KnotRemoval, WhatWasInsertedComesOutAgain) {
  std::mt19937_64 random(2);
  for (const int p : {1, 2, 3, 5}) {
    for (const auto& [name, knots] : knot_families(p)) {
      for (const double decades : {-1.0, 0.5}) {
        const auto s = random_spline<2>(random, {knots, testing::uniform_clamped(2, 2)}, decades);
        const auto middles = span_midpoints(knots, knots.domain());
        const auto finer = insert_knots<2>(s, {middles, {}});
        const auto back = remove_knots(*finer, 0, 1e-12);
        ASSERT_TRUE(back) << name;
        EXPECT_GE(back->removed.size(), middles.size()) << name;
        EXPECT_LE(back->error_bound, 1e-12) << name;
        EXPECT_LE(distance(*finer, back->spline), back->error_bound) << name;
        EXPECT_EQ(back->spline.net()[0] + static_cast<int>(back->removed.size()), finer->net()[0]);
      }
    }
  }
}

/// Control points and weights (10^±decades; none below 0) that vary slowly over the domain, with
/// some noise.
Surface smooth(const std::array<KnotVector, 2>& knots, double decades, double noise) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-noise, noise);
  Points points(knots[0].count() * knots[1].count(), 3);
  std::vector<double> weights;
  const auto place = [](const KnotVector& k, int i) {
    return (k.greville(i) - k.domain().lower) / k.domain().length();
  };
  for (int i = 0; i < knots[0].count(); ++i) {
    for (int j = 0; j < knots[1].count(); ++j) {
      const double u = place(knots[0], i), v = place(knots[1], j);
      points.row(i * knots[1].count() + j) << u, v, 0.1 * std::sin(3 * v + u) + uniform(random);
      if (decades >= 0)
        weights.push_back(std::pow(10, decades * std::sin(2 * v)) * (1 + uniform(random)));
    }
  }
  return make_spline<2>(knots, points, weights);
}

TEST(KnotRemoval, TheShapeStaysWithinTheBoundAndTheBoundWithinTheTolerance) {
  std::mt19937_64 random(3);
  for (const double decades : {-1.0, 0.3, 6.0}) {
    for (const double tolerance : {1e-9, 1e-4, 1e-3, 1e-2, 1e-1, 10.0}) {
      int removed = 0;
      for (const int p : {1, 2, 3, 5}) {
        for (const auto& [name, knots] : knot_families(p)) {
          const std::array both{testing::uniform_clamped(2, 2), knots};
          for (const auto& s : {random_spline<2>(random, both, decades), smooth(both, decades, 0),
                                smooth(both, decades, 0.1 * tolerance)}) {
            const auto less = remove_knots(s, 1, tolerance);
            ASSERT_TRUE(less) << name;
            EXPECT_LE(less->error_bound, tolerance) << name;
            // What evaluation rounds is allowed beside the bound.
            EXPECT_LE(distance(s, less->spline), less->error_bound + 64 * (p + 1) * 0x1p-52)
                << name << tolerance;
            removed += static_cast<int>(less->removed.size());
          }
        }
      }
      if (tolerance >= 1e-4) {
        EXPECT_GT(removed, 50) << tolerance << ", weights 1e+-" << decades;
      }
    }
  }
}

TEST(KnotRemoval, AToleranceIsUsed) {
  const auto knots = testing::uniform_clamped(3, 40);
  const auto s = landscape({knots, testing::uniform_clamped(3, 10)});
  std::size_t before = 0;
  for (const double tolerance : {1e-6, 1e-4, 1e-3, 1e-2}) {
    const auto less = remove_knots(s, 0, tolerance);
    ASSERT_TRUE(less);
    EXPECT_LE(distance(s, less->spline), tolerance);
    EXPECT_GE(less->removed.size(), before);
    before = less->removed.size();
  }
  EXPECT_GE(before, 20U) << "a sine of two periods and a half needs less than half of forty spans";
}

TEST(KnotRemoval, AFullCircleIsNotFlattened) {
  // Nine points, double knots at the quadrants: nothing can go at 1e-6; knots inserted by
  // refinement can.
  const double w = std::sqrt(0.5);
  Points net(9, 3);
  net << 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0, -1, 0, 0, -1, -1, 0, 0, -1, 0, 1, -1, 0, 1, 0, 0;
  const auto circle = make_spline<1>({clamped_knots(2, {0, 1, 2, 3, 4}, {0, 2, 2, 2, 0})}, net,
                                     {1, w, 1, w, 1, w, 1, w, 1});
  const auto same = remove_knots(circle, 0, 1e-6);
  ASSERT_TRUE(same);
  EXPECT_TRUE(same->removed.empty());
  EXPECT_EQ(same->error_bound, 0);
  EXPECT_EQ(same->spline.control_points(), circle.control_points());
  const auto finer = insert_knots<1>(circle, {std::vector{0.3, 1.7, 1.7, 3.9}});
  const auto back = remove_knots(*finer, 0, 1e-12);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->removed, (std::vector{0.3, 1.7, 1.7, 3.9}));
  EXPECT_EQ(back->spline.knots(), circle.knots());
  EXPECT_LE((back->spline.control_points() - net).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(KnotRemoval, EndsAndRowsThatAreNotTouchedKeepTheirBits) {
  const auto knots = testing::uniform_clamped(3, 30);
  const auto s = landscape({knots, testing::uniform_clamped(2, 3)}, 1e-3);
  const auto finer = insert_knots<2>(s, {std::vector{15.5}, {}});
  const auto back = remove_knots(*finer, 0, 1e-10);
  ASSERT_TRUE(back);
  ASSERT_EQ(back->removed, (std::vector{15.5}));
  const auto columns = s.net()[1];
  for (int i = 0; i < s.net()[0]; ++i) {
    if (15 <= i && i <= 18) continue;  // the rows that took the change
    EXPECT_EQ(std::memcmp(back->spline.control_points().row(i * columns).data(),
                          s.control_points().row(i * columns).data(),
                          static_cast<std::size_t>(24 * columns)),
              0)
        << i;
  }
  const auto rough = remove_knots(s, 0, 0.5);
  ASSERT_TRUE(rough);
  EXPECT_GT(rough->removed.size(), 20U);
  EXPECT_EQ(rough->spline.control_points().topRows(columns), s.control_points().topRows(columns));
  EXPECT_EQ(rough->spline.control_points().bottomRows(columns),
            s.control_points().bottomRows(columns));
}

TEST(KnotRemoval, CompanionsKeepTheirShapesToo) {
  const auto knots = testing::uniform_clamped(3, 20);
  const auto s = landscape({knots, testing::uniform_clamped(2, 3)});
  Points bump = Points::Zero(s.size(), 3);
  bump.row(11 * s.net()[1] + 2).z() = 1;
  const auto alone = remove_knots(s, 0, 1e-2),
             together = remove_knots(s, 0, 1e-2, std::span(&bump, 1));
  ASSERT_TRUE(alone);
  ASSERT_TRUE(together);
  EXPECT_LT(together->removed.size(), alone->removed.size());
  ASSERT_EQ(together->companions.size(), 1U);
  EXPECT_LE(distance(*s.with_control_points(bump),
                     *together->spline.with_control_points(together->companions[0])),
            together->error_bound);
}

TEST(KnotRemoval, ALargeNetTakesSeconds) {
  const auto coarse =
      landscape({testing::uniform_clamped(3, 100), testing::uniform_clamped(3, 297)}, 0.1);
  const auto finer =
      insert_knots<2>(coarse, {span_midpoints(coarse.knots(0), coarse.knots(0).domain()), {}});
  ASSERT_TRUE(finer);
  const auto back = remove_knots(*finer, 0, 1e-9);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->removed.size(), 100U);
  EXPECT_EQ(back->spline.knots(), coarse.knots());
  EXPECT_LE((back->spline.control_points() - coarse.control_points()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(KnotRemoval, WrongArgumentsAreErrors) {
  const auto s = landscape({testing::uniform_clamped(3, 4), testing::uniform_clamped(2, 3)});
  for (const double tolerance : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(remove_knots(s, 0, tolerance).error().kind, ErrorKind::input);
  }
  const auto nothing = remove_knots(s, 0, 0);
  ASSERT_TRUE(nothing);
  EXPECT_TRUE(nothing->removed.empty());
  const Points wrong = Points::Zero(3, 3);
  EXPECT_NE(remove_knots(s, 0, 1, std::span(&wrong, 1)).error().message().find("companion 0"),
            std::string::npos);
  std::vector<double> weights(static_cast<std::size_t>(s.size()), 1.0);
  weights[5] = 0;
  const auto heavy = make_spline<2>(s.knots(), s.control_points(), weights);
  EXPECT_NE(remove_knots(heavy, 0, 1).error().message().find("control point 5"), std::string::npos);
}

}  // namespace
}  // namespace knead
