#include "knead/spline/evaluate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

#include "sample_splines.hpp"

namespace knead {
namespace {

/// Parts of one piece of memory, with a number after each that is not theirs.
struct Memory {
  static constexpr double foreign = -7;
  std::size_t numbers;
  std::vector<double> all;
  std::vector<std::span<double>> parts;

  Memory(std::size_t count, std::size_t points)
      : numbers(3 * points), all(count * (numbers + 1), foreign) {
    for (std::size_t k = 0; k < count; ++k)
      parts.push_back(std::span(all).subspan(k * (numbers + 1), numbers));
  }
};

template <int D>
void expect_holds(const Memory& memory, const Evaluation<D>& expected) {
  for (std::size_t k = 0; k < memory.parts.size(); ++k) {
    const std::span<const double> wanted(expected.derivatives[k].data(), memory.numbers);
    EXPECT_TRUE(std::ranges::equal(memory.parts[k], wanted)) << "derivative " << k;
    EXPECT_EQ(memory.all[k * (memory.numbers + 1) + memory.numbers], Memory::foreign)
        << "after derivative " << k;
  }
}

/// Memory of the caller gets the bits of `evaluate` and `evaluate_grid`, and nothing beside it is
/// written.
template <int D>
void expect_same_bits(const Spline<D>& spline, int order) {
  const auto grid = testing::grid_of(spline);
  const Parameters<D> rows = testing::rows_of<D>(grid);
  std::array<BasisTable, D> lines, points;
  std::array<const BasisTable*, D> line_tables, point_tables;
  for (std::size_t d = 0; d < D; ++d) {
    const Eigen::VectorXd column = rows.col(static_cast<Eigen::Index>(d));
    lines[d] = *tabulate_basis(spline.knots()[d], grid[d], order);
    points[d] = *tabulate_basis(spline.knots()[d],
                                {column.data(), static_cast<std::size_t>(column.size())}, order);
    line_tables[d] = &lines[d];
    point_tables[d] = &points[d];
  }
  const auto expected = evaluate<D>(spline, rows, order);
  ASSERT_TRUE(expected);
  const std::size_t count = expected->derivatives.size();
  Memory scattered(count, static_cast<std::size_t>(rows.rows())), gridded = scattered;
  gridded = Memory(count, static_cast<std::size_t>(rows.rows()));
  ASSERT_TRUE(evaluate_into<D>(spline, point_tables, order, scattered.parts));
  ASSERT_TRUE(evaluate_grid_into<D>(spline, line_tables, order, gridded.parts));
  expect_holds(scattered, *expected);
  expect_holds(gridded, *expected);
}

TEST(EvaluateInto, HasTheBitsOfEvaluation) {
  std::mt19937_64 random(41);
  for (int p = 1; p <= 5; ++p) {
    for (const auto& [name, knots] : testing::knot_families(p)) {
      SCOPED_TRACE(name);
      expect_same_bits<1>(testing::random_spline<1>(random, {knots}), 2);
      expect_same_bits<1>(testing::random_spline<1>(random, {knots}, 1), 2);
    }
    const auto u = testing::random_knots(random, p), v = testing::random_knots(random, 3);
    expect_same_bits<2>(testing::random_spline<2>(random, {u, v}), 2);
    expect_same_bits<2>(testing::random_spline<2>(random, {u, v}, 1), 2);
  }
  const auto u = testing::uniform_clamped(2, 3), v = testing::uniform_clamped(1, 3),
             w = testing::uniform_unclamped(3, 2);
  expect_same_bits<3>(testing::random_spline<3>(random, {u, v, w}), 1);
  expect_same_bits<3>(testing::random_spline<3>(random, {u, v, w}, 1), 1);
}

TEST(EvaluateInto, NoPointsNeedNoMemory) {
  std::mt19937_64 random(42);
  const auto curve = testing::random_spline<1>(random, {testing::uniform_clamped(3, 4)});
  const BasisTable none = *tabulate_basis(curve.knots()[0], {}, 0);
  const std::array<std::span<double>, 1> parts;
  EXPECT_TRUE(evaluate_into<1>(curve, {&none}, 0, parts));
  EXPECT_TRUE(evaluate_grid_into<1>(curve, {&none}, 0, parts));
}

}  // namespace
}  // namespace knead
