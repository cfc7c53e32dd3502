#include "spline/grid_lines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

constexpr double pi = std::numbers::pi;

/// A band of eight turns, about a helix, with the degree, knots and net that a thread of a screw
/// has: 13 × 1, 98 × 2, one span per turn, joined with multiplicity 12.
Surface thread(double radius, double pitch) {
  constexpr double turns = 8;
  std::vector<double> values(14, 0.0);
  for (int k = 1; k < 8; ++k) values.insert(values.end(), 12, k / 8.0);
  values.insert(values.end(), 14, 1.0);
  auto knots = KnotVector::create(13, std::move(values));
  const auto greville = [&](int i) {
    double sum = 0;
    for (int k = 1; k <= 13; ++k) sum += (*knots)[i + k];
    return sum / 13;
  };
  Points net(196, 3);
  for (int i = 0; i < 98; ++i) {
    const double a = 2 * pi * turns * greville(i);
    for (int j = 0; j < 2; ++j) {
      const double r = radius * (1 - 0.1 * j);
      net.row(2 * i + j) << r * std::cos(a), r * std::sin(a), pitch * a / (2 * pi) + 0.1 * j;
    }
  }
  return *Surface::create({*std::move(knots), *KnotVector::clamped_uniform(1, 2)}, std::move(net));
}

/// The largest distance of the middles of chords along a direction from the surface there, across
/// the chord.
double chord_error(const Surface& surface, const std::array<GridLines, 2>& lines, int d) {
  double most = 0;
  const auto& along = lines[static_cast<std::size_t>(d)].parameters;
  for (const double v : lines[static_cast<std::size_t>(1 - d)].parameters) {
    const auto at = [&](double u) {
      return *evaluate_point<2>(surface, d == 0 ? std::array{u, v} : std::array{v, u});
    };
    for (std::size_t k = 0; k + 1 < along.size(); ++k) {
      const Point a = at(along[k]), b = at(along[k + 1]);
      const double length = (b - a).norm();
      for (const double share : {0.25, 0.5, 0.75}) {
        const Point p = at(std::lerp(along[k], along[k + 1], share)) - a;
        const Point t = length > 0 ? Point((b - a) / length) : Point(Point::Zero());
        most = std::max(most, (p - p.dot(t) * t).norm());
      }
    }
  }
  return most;
}

TEST(GridLines, AThreadOfManyTurnsIsRoundToTheTolerance) {
  const Surface surface = thread(3, 1);
  const GridLines coarse = grid_lines(surface.knots(0), 96);
  EXPECT_GT(chord_error(surface, {coarse, grid_lines(surface.knots(1), 96)}, 0),
            0.05);  // a twelve-sided nut
  for (const double tolerance : {0.01, 0.001}) {
    const auto lines = grid_lines(surface, {.tolerance = tolerance});
    ASSERT_TRUE(lines) << lines.error().message();
    EXPECT_LE(chord_error(surface, *lines, 0), 1.2 * tolerance);
    EXPECT_LE(static_cast<double>((*lines)[0].parameters.size()),
              4.2 * 8 * pi / std::sqrt(8 * tolerance / 3) + 100);
    EXPECT_EQ((*lines)[1].parameters.size(), 2U);  // straight
    for (const auto k : (*lines)[0].knot_lines) ASSERT_LT(k, (*lines)[0].parameters.size());
    EXPECT_EQ((*lines)[0].knot_lines.size(), surface.knots(0).spans().size() + 1);
  }
}

TEST(GridLines, WhatIsFlatHasTheLinesOfItsKnots) {
  Points net(16, 3);
  for (int k = 0; k < 16; ++k) net.row(k) << k / 4, k % 4, 0;
  const auto sheet = Surface::create(
      {*KnotVector::clamped_uniform(3, 4), *KnotVector::clamped_uniform(3, 4)}, std::move(net));
  const auto lines = grid_lines(*sheet, {.tolerance = 1e-6});
  ASSERT_TRUE(lines);
  for (std::size_t d = 0; d < 2; ++d) {
    EXPECT_EQ((*lines)[d].parameters, grid_lines(sheet->knots(static_cast<int>(d)), 96).parameters);
  }
}

TEST(GridLines, TheLimitsHold) {
  const Surface surface = thread(3, 1);
  const auto few = grid_lines(surface, {.tolerance = 1e-9, .most = 300});
  ASSERT_TRUE(few);
  EXPECT_LE((*few)[0].parameters.size(), 300U);
  const auto points = grid_lines(surface, {.tolerance = 1e-9, .most_points = 500});
  ASSERT_TRUE(points);
  EXPECT_LE((*points)[0].parameters.size() * (*points)[1].parameters.size(), 500U);
  // The knots' own lines are more than that: they stay.
  EXPECT_EQ((*grid_lines(surface, {.tolerance = 1e-9, .most = 3}))[0].parameters,
            grid_lines(surface.knots(0), 96).parameters);
}

TEST(GridLines, AreFinerInAWindowAlone) {
  const Surface surface = thread(3, 1);
  const GridWindow window{{0.3, 0.2}, {0.31, 0.4}, 1e-6};
  const auto far = grid_lines(surface, {.tolerance = 0.01}),
             near = grid_lines(surface, {.tolerance = 0.01, .window = window});
  ASSERT_TRUE(far);
  ASSERT_TRUE(near);
  EXPECT_TRUE((*far)[0].coarse.empty());
  for (std::size_t d = 0; d < 2; ++d) {
    const GridLines &coarse = (*far)[d], &fine = (*near)[d];
    ASSERT_EQ(fine.coarse.size(), coarse.parameters.size());
    for (std::size_t k = 0; k < fine.coarse.size(); ++k) {
      EXPECT_EQ(fine.parameters[fine.coarse[k]], coarse.parameters[k]);
    }
    ASSERT_EQ(fine.knot_lines.size(), coarse.knot_lines.size());
    for (std::size_t k = 0; k < fine.knot_lines.size(); ++k) {
      EXPECT_EQ(fine.parameters[fine.knot_lines[k]], coarse.parameters[coarse.knot_lines[k]]);
    }
    EXPECT_TRUE(std::ranges::is_sorted(fine.parameters));
  }
  std::array<GridLines, 2> inside;
  for (std::size_t d = 0; d < 2; ++d) {
    for (const double u : (*near)[d].parameters) {
      if (u >= window.lower[d] && u <= window.upper[d]) inside[d].parameters.push_back(u);
    }
  }
  EXPECT_LE(chord_error(surface, inside, 0), 1.2e-6);
  // A hundredth of the thread takes fewer lines than all of it would.
  EXPECT_LT((*near)[0].parameters.size(), (*far)[0].parameters.size() + 500);
}

TEST(GridLines, OfAWindowKeepToTheirLimits) {
  const Surface surface = thread(3, 1);
  const GridWindow whole{{0, 0}, {1, 1}, 1e-12};
  const auto lines = grid_lines(surface, {.tolerance = 0.01, .most = 900, .window = whole});
  ASSERT_TRUE(lines);
  EXPECT_LE((*lines)[0].parameters.size(), 900U);
  EXPECT_GT((*lines)[0].parameters.size(),
            grid_lines(surface, {.tolerance = 0.01})->at(0).parameters.size());
}

}  // namespace
}  // namespace knead
