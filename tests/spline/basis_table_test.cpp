#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "base/gauss_legendre.hpp"
#include "knead/spline/basis.hpp"
#include "support/knot_families.hpp"
#include "support/numbers.hpp"

namespace knead {
namespace {

using testing::epsilon;

TEST(BasisTable, RowsAreTheBasisAtEachParameterInTheGivenOrder) {
  const KnotVector knots = testing::uniform_clamped(3, 5);
  const std::vector<double> parameters = {4.5, 0, 5, 2, 2, 1.25};
  const auto table = tabulate_basis(knots, parameters, 2);
  ASSERT_TRUE(table);
  ASSERT_EQ(table->size(), 6);
  EXPECT_EQ(table->degree, 3);
  EXPECT_EQ(table->order, 2);
  for (int k = 0; k < table->size(); ++k) {
    const double u = parameters[static_cast<std::size_t>(k)];
    const int s = knots.find_span(u);
    EXPECT_EQ(table->first[static_cast<std::size_t>(k)], s - 3);
    double expected[12];
    basis_derivatives(knots, s, u, 2, expected);
    for (int d = 0; d <= 2; ++d) {
      for (int r = 0; r <= 3; ++r) EXPECT_EQ(table->row(k, d)[r], expected[4 * d + r]);
    }
  }
}

TEST(BasisTable, SideDecidesAtKnotsAndOnlyThere) {
  const KnotVector knots = testing::make_knots(1, {0, 0, 1, 1, 2, 2});
  const std::vector<double> parameters = {0, 0.5, 1, 2};
  const auto left = tabulate_basis(knots, parameters, 0, Side::left),
             right = tabulate_basis(knots, parameters, 0);
  EXPECT_EQ(left->first, (std::vector{0, 0, 0, 2}));
  EXPECT_EQ(right->first, (std::vector{0, 0, 2, 2}));
}

TEST(BasisTable, NoParametersGiveAnEmptyTable) {
  const auto table = tabulate_basis(testing::uniform_clamped(2, 2), {}, 1);
  ASSERT_TRUE(table);
  EXPECT_EQ(table->size(), 0);
}

TEST(BasisTable, FirstParameterOutsideOfTheDomainIsNamed) {
  const KnotVector knots = testing::uniform_unclamped(2, 3);  // knots 0 … 7, domain [2, 5]
  for (const double bad :
       {1.0, std::nextafter(2.0, 1.0), std::nextafter(5.0, 6.0),
        std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    const std::vector<double> parameters = {2, 5, bad, 9};
    const auto table = tabulate_basis(knots, parameters, 0);
    ASSERT_FALSE(table);
    EXPECT_EQ(table.error().kind, ErrorKind::input);
    EXPECT_EQ(table.error().where, "parameter 2");
  }
}

TEST(BasisTable, NegativeOrderIsRefused) {
  const auto table = tabulate_basis(testing::uniform_clamped(2, 2), std::vector<double>{0.5}, -1);
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().kind, ErrorKind::usage);
}

class Quadrature : public ::testing::TestWithParam<int> {};

TEST_P(Quadrature, WeightsArePositiveAndSumToTheDomain) {
  for (const auto& [name, knots] : testing::knot_families(GetParam())) {
    const auto rule = gauss_basis(knots, 4, 0);
    EXPECT_TRUE(std::ranges::is_sorted(rule.parameters)) << name;
    EXPECT_GT(*std::ranges::min_element(rule.weights), 0) << name;
    const double sum = std::accumulate(rule.weights.begin(), rule.weights.end(), 0.0);
    EXPECT_NEAR(sum / knots.domain().length(), 1,
                4 * epsilon * static_cast<double>(rule.weights.size()))
        << name;
  }
}

TEST_P(Quadrature, AreaOfEveryFunctionIsExact) {
  // ∫ N_i = (x_{i+p+1} − x_i) / (p + 1) where the support lies in the domain (thesis Thm 5.2).
  const int p = GetParam();
  for (const auto& [name, knots] : testing::knot_families(p)) {
    if (!knots.clamped()) continue;
    for (const int pieces : {1, 3}) {
      const std::vector<int> split(knots.spans().size(), pieces);
      const auto rule = gauss_basis(knots, p / 2 + 1, 0, split);
      ASSERT_EQ(rule.parameters.size(),
                split.size() * static_cast<std::size_t>(pieces * (p / 2 + 1)));
      std::vector<double> area(static_cast<std::size_t>(knots.count()), 0.0);
      for (int k = 0; k < rule.basis.size(); ++k) {
        const auto at = static_cast<std::size_t>(k);
        for (int r = 0; r <= p; ++r) {
          area[static_cast<std::size_t>(rule.basis.first[at] + r)] +=
              rule.weights[at] * rule.basis.row(k, 0)[r];
        }
      }
      // A span of a few ulp of its knots places its points to that accuracy only.
      double shortest = knots.domain().length(), largest = 0;
      for (const int s : knots.spans()) shortest = std::min(shortest, knots[s + 1] - knots[s]);
      for (const double x : knots.knots()) largest = std::max(largest, std::abs(x));
      const double bound = 1e-13 + 4 * p * epsilon * largest / shortest;
      for (int i = 0; i < knots.count(); ++i) {
        const double exact = (knots[i + p + 1] - knots[i]) / (p + 1);
        EXPECT_NEAR(area[static_cast<std::size_t>(i)] / exact, 1, bound)
            << name << ", function " << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllDegrees, Quadrature, ::testing::Range(1, max_degree + 1));

TEST(GaussBasis, UnequalPiecesSplitTheirSpansEqually) {
  const KnotVector knots = testing::make_knots(1, {0, 0, 1, 3, 3});
  const std::vector<int> pieces = {1, 2};
  const auto rule = gauss_basis(knots, 1, 1, pieces);
  EXPECT_EQ(rule.parameters, (std::vector{0.5, 1.5, 2.5}));
  EXPECT_EQ(rule.weights, (std::vector{1.0, 1.0, 1.0}));
  EXPECT_EQ(rule.basis.first, (std::vector{0, 1, 1}));
  EXPECT_EQ(rule.basis.row(2, 1)[0], -0.5);
}

TEST(GaussBasis, PointsStayInsideSpansOfOneUlp) {
  const double b = std::nextafter(1.0, 2.0);
  const KnotVector knots = testing::make_knots(1, {0, 0, 1, b, 2, 2});
  const auto rule = gauss_basis(knots, 5, 0);
  for (int k = 5; k < 10; ++k) {
    EXPECT_LE(1, rule.parameters[static_cast<std::size_t>(k)]);
    EXPECT_LE(rule.parameters[static_cast<std::size_t>(k)], b);
  }
}

}  // namespace
}  // namespace knead
