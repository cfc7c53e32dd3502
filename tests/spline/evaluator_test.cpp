#include "knead/spline/evaluate.hpp"

#include <gtest/gtest.h>

#include "sample_splines.hpp"
#include "support/thread_counts.hpp"

namespace knead {
namespace {

/// Every derivative has the same bits.
template <int D>
void expect_equal(const Evaluation<D>& a, const Evaluation<D>& b) {
  EXPECT_EQ(a.order, b.order);
  ASSERT_EQ(a.derivatives.size(), b.derivatives.size());
  for (std::size_t k = 0; k < a.derivatives.size(); ++k) {
    ASSERT_EQ(a.derivatives[k].rows(), b.derivatives[k].rows());
    EXPECT_TRUE((a.derivatives[k].array() == b.derivatives[k].array()).all()) << "derivative " << k;
  }
}

/// Evaluators of a spline's knots serve other nets, rational or not, with the bits of evaluation
/// from scratch.
template <int D>
void expect_kept(std::mt19937_64& random, const std::array<KnotVector, D>& knots) {
  const auto first = testing::random_spline<D>(random, knots);
  const auto grid = testing::grid_of(first);
  const Parameters<D> rows = testing::rows_of<D>(grid);
  for (const Side side : {Side::left, Side::right}) {
    const auto on_grid = Evaluator<D>::on_grid(knots, testing::spans_of<D>(grid), 2, side);
    const auto at_points = Evaluator<D>::at_points(knots, rows, 2, side);
    ASSERT_TRUE(on_grid && at_points);
    EXPECT_EQ(on_grid->size(), rows.rows());
    EXPECT_EQ(at_points->size(), rows.rows());
    EXPECT_EQ(on_grid->order(), 2);
    Evaluation<D> result;  // whose memory every one uses
    for (const double decades : {-1.0, 0.5, -1.0}) {
      const auto spline = testing::random_spline<D>(random, knots, decades);
      const auto expected = evaluate<D>(spline, rows, 2, side);
      ASSERT_TRUE(expected);
      ASSERT_TRUE(on_grid->evaluate(spline, result));
      expect_equal(result, *expected);
      ASSERT_TRUE(at_points->evaluate(spline, result));
      expect_equal(result, *expected);
      expect_equal(*at_points->evaluate(spline), *expected);
    }
  }
}

TEST(Evaluator, ServesEveryNetOfItsKnots) {
  std::mt19937_64 random(31);
  for (int p = 1; p <= 5; ++p) {
    for (const auto& [name, knots] : testing::knot_families(p)) {
      SCOPED_TRACE(name);
      expect_kept<1>(random, {knots});
    }
    expect_kept<2>(random, {testing::random_knots(random, p), testing::random_knots(random, 3)});
  }
  expect_kept<3>(random, {testing::uniform_clamped(2, 3), testing::uniform_clamped(1, 3),
                          testing::uniform_unclamped(3, 2)});
}

TEST(Evaluator, RefusesOtherKnots) {
  std::mt19937_64 random(32);
  const auto u = testing::uniform_clamped(3, 4), v = testing::uniform_clamped(2, 4),
             w = testing::uniform_clamped(2, 5);
  const auto evaluator = Evaluator<2>::at_points({u, v}, Parameters<2>{{1, 2}});
  ASSERT_TRUE(evaluator);
  const auto refused = evaluator->evaluate(testing::random_spline<2>(random, {u, w}));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::usage);
  EXPECT_EQ(refused.error().where, "direction 1");
}

TEST(Evaluator, ParameterOutsideIsNamedByDirectionAndIndex) {
  const auto u = testing::uniform_clamped(3, 4), v = testing::uniform_clamped(2, 4);
  const auto scattered = Evaluator<2>::at_points({u, v}, Parameters<2>{{1, 2}, {2, 9}});
  ASSERT_FALSE(scattered);
  EXPECT_EQ(scattered.error().where, "direction 1: parameter 1");
  const std::vector<double> inside = {0, 1}, outside = {0, 1, 2, -1};
  const auto grid = Evaluator<2>::on_grid({u, v}, {outside, inside});
  ASSERT_FALSE(grid);
  EXPECT_EQ(grid.error().where, "direction 0: parameter 3");
}

/// A surface with parameters enough for several threads.
struct Large {
  Surface surface;
  std::vector<double> u, v;
};

Large large(double decades) {
  std::mt19937_64 random(33);
  const auto knots = testing::uniform_clamped(3, 20);
  Large result{testing::random_spline<2>(random, {knots, knots}, decades), {}, {}};
  for (int k = 0; k <= 230; ++k) result.u.push_back(20 * (k / 230.0));
  for (int k = 0; k <= 210; ++k) result.v.push_back(20 * (k / 210.0));
  return result;
}

TEST(Evaluator, BitsDoNotDependOnTheNumberOfThreads) {
  for (const double decades : {-1.0, 0.3}) {
    const Large sample = large(decades);
    const std::array<std::span<const double>, 2> grid = {sample.u, sample.v};
    const Parameters<2> rows = testing::rows_of<2>({sample.u, sample.v});
    const auto expected =
        testing::with_threads(1, [&] { return evaluate_grid<2>(sample.surface, grid, 2); });
    ASSERT_TRUE(expected);
    for (const int threads : testing::thread_counts) {
      SCOPED_TRACE(threads);
      const auto found = testing::with_threads(threads, [&] {
        return std::array{evaluate_grid<2>(sample.surface, grid, 2),
                          evaluate<2>(sample.surface, rows, 2)};
      });
      for (const auto& one : found) {
        ASSERT_TRUE(one);
        expect_equal(*one, *expected);
      }
    }
  }
}

TEST(Evaluator, BitsOfVolumesDoNotDependOnTheNumberOfThreads) {
  std::mt19937_64 random(34);
  const auto knots = testing::uniform_clamped(2, 6);
  const auto volume = testing::random_spline<3>(random, {knots, knots, knots}, 0.3);
  std::vector<double> u;
  for (int k = 0; k <= 32; ++k) u.push_back(6 * (k / 32.0));
  const auto run = [&] { return evaluate_grid<3>(volume, {u, u, u}, 1); };
  const auto expected = testing::with_threads(1, run);
  for (const int threads : testing::thread_counts)
    expect_equal(*testing::with_threads(threads, run), *expected);
}

TEST(Evaluator, TheFirstBadDenominatorIsNamedWithAnyNumberOfThreads) {
  Large sample = large(0.3);
  // Around the control point (15, 12) and the one after it the denominator is negative.
  std::vector<double> weights(sample.surface.weights().begin(), sample.surface.weights().end());
  const int n = sample.surface.net()[1];
  weights[static_cast<std::size_t>(15 * n + 12)] = weights[static_cast<std::size_t>(16 * n + 12)] =
      -1e3;
  const auto bad =
      testing::make_spline<2>(sample.surface.knots(), sample.surface.control_points(), weights);
  const std::array<std::span<const double>, 2> grid = {sample.u, sample.v};
  const Parameters<2> rows = testing::rows_of<2>({sample.u, sample.v});
  const auto run = [&] {
    return std::array{evaluate_grid<2>(bad, grid, 1), evaluate<2>(bad, rows, 1)};
  };
  const auto expected = testing::with_threads(1, run);
  for (const int threads : testing::thread_counts) {
    const auto found = testing::with_threads(threads, run);
    for (std::size_t k = 0; k < 2; ++k) {
      ASSERT_FALSE(found[k]);
      EXPECT_EQ(found[k].error().message(), expected[k].error().message());
    }
  }
}

}  // namespace
}  // namespace knead
