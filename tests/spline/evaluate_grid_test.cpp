#include <gtest/gtest.h>

#include <limits>

#include "sample_splines.hpp"

namespace knead {
namespace {

/// The grid and the scattered form give the same bits, for every derivative.
template <int D>
void expect_same_bits(const Spline<D>& spline, int order) {
  const auto grid = testing::grid_of(spline);
  for (const Side side : {Side::left, Side::right}) {
    const auto scattered = evaluate<D>(spline, testing::rows_of<D>(grid), order, side);
    const auto gridded = evaluate_grid<D>(spline, testing::spans_of<D>(grid), order, side);
    ASSERT_TRUE(scattered && gridded);
    ASSERT_EQ(gridded->order, order);
    ASSERT_EQ(gridded->derivatives.size(), scattered->derivatives.size());
    for (std::size_t k = 0; k < scattered->derivatives.size(); ++k) {
      ASSERT_EQ(gridded->derivatives[k].rows(), scattered->derivatives[k].rows());
      EXPECT_TRUE((gridded->derivatives[k].array() == scattered->derivatives[k].array()).all())
          << "derivative " << k;
    }
  }
}

TEST(EvaluateGrid, CurvesHaveTheBitsOfTheirPoints) {
  std::mt19937_64 random(11);
  for (int p = 1; p <= max_degree; ++p) {
    for (const auto& [name, knots] : testing::knot_families(p)) {
      SCOPED_TRACE(name);
      expect_same_bits<1>(testing::random_spline<1>(random, {knots}), 2);
      expect_same_bits<1>(testing::random_spline<1>(random, {knots}, 1), 2);
    }
  }
}

TEST(EvaluateGrid, SurfacesHaveTheBitsOfTheirPoints) {
  std::mt19937_64 random(12);
  for (int p = 1; p <= 7; ++p) {
    for (int q = 1; q <= 5; ++q) {
      const auto u = testing::random_knots(random, p), v = testing::random_knots(random, q);
      expect_same_bits<2>(testing::random_spline<2>(random, {u, v}), 3);
      expect_same_bits<2>(testing::random_spline<2>(random, {u, v}, 2), 3);
    }
  }
}

TEST(EvaluateGrid, VolumesHaveTheBitsOfTheirPoints) {
  std::mt19937_64 random(13);
  const auto u = testing::clamped_knots(2, {0, 1, 2}, {0, 2, 0}),
             v = testing::uniform_clamped(1, 3);
  const auto w = testing::uniform_unclamped(3, 2);
  expect_same_bits<3>(testing::random_spline<3>(random, {u, v, w}), 2);
  expect_same_bits<3>(testing::random_spline<3>(random, {u, v, w}, 1), 2);
}

TEST(EvaluateGrid, ParametersMayComeInAnyOrderAndRepeat) {
  std::mt19937_64 random(14);
  const auto spline = testing::random_spline<2>(
      random, {testing::uniform_clamped(3, 4), testing::uniform_clamped(2, 4)});
  const std::array<std::vector<double>, 2> grid = {std::vector<double>{4, 0, 2.5, 2.5},
                                                   {3.5, 0.5, 0.25, 3, 3, 4, 0}};
  const auto gridded = evaluate_grid<2>(spline, testing::spans_of<2>(grid), 1);
  const auto scattered = evaluate<2>(spline, testing::rows_of<2>(grid), 1);
  ASSERT_TRUE(gridded && scattered);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_TRUE((gridded->derivatives[k].array() == scattered->derivatives[k].array()).all());
  }
}

TEST(EvaluateGrid, MemoryOfAnEarlierResultDoesNotShowThrough) {
  std::mt19937_64 random(15);
  const auto spline = testing::random_spline<2>(
      random, {testing::uniform_clamped(3, 4), testing::uniform_clamped(2, 4)});
  const auto fine = tabulate_basis(spline.knots(0), testing::places(spline.knots(0)), 2);
  const auto coarse = tabulate_basis(spline.knots(0), std::vector<double>{1, 3}, 2);
  const auto across = tabulate_basis(spline.knots(1), testing::places(spline.knots(1)), 2);
  Evaluation<2> result;
  ASSERT_TRUE(evaluate_grid<2>(spline, {&*fine, &*across}, 2, result));
  ASSERT_TRUE(evaluate_grid<2>(spline, {&*coarse, &*across}, 1, result));
  const auto fresh = evaluate_grid<2>(spline, {&*coarse, &*across}, 1);
  EXPECT_EQ(result.order, 1);
  ASSERT_EQ(result.derivatives.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(result.derivatives[k], fresh->derivatives[k]);
}

TEST(EvaluateGrid, GridWithoutParametersIsEmpty) {
  std::mt19937_64 random(16);
  const auto spline = testing::random_spline<2>(
      random, {testing::uniform_clamped(3, 4), testing::uniform_clamped(2, 4)});
  const std::array<std::vector<double>, 2> grid = {std::vector<double>{1, 2}, {}};
  const auto result = evaluate_grid<2>(spline, testing::spans_of<2>(grid), 1);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->points().rows(), 0);
  EXPECT_EQ(result->derivatives.size(), 3u);
}

TEST(EvaluateGrid, ParameterOutsideIsNamedByDirectionAndIndex) {
  std::mt19937_64 random(17);
  const auto spline = testing::random_spline<2>(
      random, {testing::uniform_clamped(3, 4), testing::uniform_clamped(2, 4)});
  const std::array<std::vector<double>, 2> grid = {std::vector<double>{1, 2}, {0, 1, 4.5}};
  const auto result = evaluate_grid<2>(spline, testing::spans_of<2>(grid));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::input);
  EXPECT_EQ(result.error().where, "direction 1: parameter 2");
}

}  // namespace
}  // namespace knead
