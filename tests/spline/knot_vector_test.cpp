#include "knead/spline/knot_vector.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/knot_families.hpp"
#include "support/numbers.hpp"

namespace knead {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using testing::nan;

void expect_error(int degree, std::vector<double> knots, const std::string& where,
                  const std::string& what) {
  const auto made = KnotVector::create(degree, std::move(knots));
  ASSERT_FALSE(made) << "expected: " << what;
  EXPECT_EQ(made.error().kind, ErrorKind::input);
  EXPECT_EQ(made.error().where, where);
  EXPECT_EQ(made.error().what, what);
}

TEST(KnotVector, KeepsEveryKnotToTheLastBit) {
  const std::vector<double> knots = {-0.0, 0.1, 0.1 + 1e-17, 1.0 / 3, 2, std::nextafter(2, 3)};
  const auto made = KnotVector::create(2, knots);
  ASSERT_TRUE(made);
  EXPECT_TRUE(std::ranges::equal(made->knots(), knots));
  EXPECT_EQ(made->degree(), 2);
  EXPECT_EQ(made->count(), 3);
}

TEST(KnotVector, EveryDegreeFromOneToTwentyFiveIsAccepted) {
  for (int p = 1; p <= max_degree; ++p) EXPECT_TRUE(KnotVector::clamped_uniform(p, p + 3)) << p;
}

TEST(KnotVector, DegreeOutsideOfOneToTwentyFiveIsRefused) {
  expect_error(0, {0, 1}, "", "degree 0 is out of range");
  expect_error(-3, {0, 1}, "", "degree -3 is out of range");
  expect_error(26, std::vector<double>(60, 0.0), "", "degree 26 is out of range");
  EXPECT_FALSE(KnotVector::clamped_uniform(26, 30));
}

TEST(KnotVector, TooFewKnotsAreRefused) {
  expect_error(2, {0, 0, 0, 1, 1}, "knot 5", "5 knots are too few for degree 2");
  expect_error(1, {}, "knot 0", "0 knots are too few for degree 1");
}

TEST(KnotVector, FirstDecreasingKnotIsNamed) {
  expect_error(1, {0, 0, 2, 1, 0.5, 3}, "knot 3", "the knots decrease from 2 to 1");
}

TEST(KnotVector, FirstKnotThatIsNoNumberIsNamed) {
  expect_error(1, {0, 0, nan, nan}, "knot 2", "the knot is not a finite number");
  expect_error(1, {-infinity, 0, 1, 1}, "knot 0", "the knot is not a finite number");
  expect_error(1, {0, 0, 1, infinity}, "knot 3", "the knot is not a finite number");
}

TEST(KnotVector, KnotRepeatedMoreThanOrderTimesIsNamed) {
  expect_error(1, {0, 0, 1, 1, 1, 2, 2}, "knot 4", "the knot 1 is repeated more than 2 times");
  expect_error(2, {0, 0, 0, 0, 1, 1, 1}, "knot 3", "the knot 0 is repeated more than 3 times");
}

TEST(KnotVector, EmptyDomainIsRefused) {
  // Every other check passes; x_p and x_n coincide.
  expect_error(2, {0, 1, 1, 1, 2, 3}, "knots 2 and 3", "the domain is empty");
}

TEST(KnotVector, TooFewFunctionsForAClampedUniformVectorAreRefused) {
  const auto made = KnotVector::clamped_uniform(3, 3);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().remedy, "use at least 4");
}

TEST(KnotVector, EmptyOrReversedIntervalOfAClampedUniformVectorIsRefused) {
  EXPECT_FALSE(KnotVector::clamped_uniform(3, 8, 1, 1));
  EXPECT_FALSE(KnotVector::clamped_uniform(3, 8, 1, 0));
  EXPECT_FALSE(KnotVector::clamped_uniform(3, 8, 0, nan));
}

TEST(KnotVector, ClampedUniformHasItsEndsExactlyAndEqualSpans) {
  const auto made = KnotVector::clamped_uniform(2, 6, -1, 3);
  ASSERT_TRUE(made);
  const std::vector<double> expected = {-1, -1, -1, 0, 1, 2, 3, 3, 3};
  EXPECT_TRUE(std::ranges::equal(made->knots(), expected));
  EXPECT_TRUE(made->clamped());
  EXPECT_EQ(made->max_interior_multiplicity(), 1);
  EXPECT_EQ(KnotVector::clamped_uniform(3, 10, 0.1, 0.7)->domain().upper, 0.7);
}

TEST(KnotVector, EndsAreClampedOneByOne) {
  const auto start = testing::make_knots(2, {0, 0, 0, 1, 2, 3});
  EXPECT_TRUE(start.clamped_start());
  EXPECT_FALSE(start.clamped_end());
  EXPECT_FALSE(start.clamped());
  const auto end = testing::make_knots(2, {-2, -1, 0, 1, 1, 1});
  EXPECT_FALSE(end.clamped_start());
  EXPECT_TRUE(end.clamped_end());
  const auto almost = testing::make_knots(2, {-1, 0, 0, 1, 1, 2});
  EXPECT_FALSE(almost.clamped_start());
  EXPECT_FALSE(almost.clamped_end());
}

TEST(KnotVector, MultiplicityCountsExactCopies) {
  const auto knots = testing::make_knots(2, {0, 0, 0, 1, 1, 1 + 1e-15, 3, 3, 3});
  EXPECT_EQ(knots.multiplicity(0), 3);
  EXPECT_EQ(knots.multiplicity(1), 2);
  EXPECT_EQ(knots.multiplicity(2), 0);
  EXPECT_EQ(knots.max_interior_multiplicity(), 2);
}

TEST(KnotVector, KnotsOutsideOfTheDomainAreNotInterior) {
  const auto knots = testing::make_knots(2, {-1, -1, 0, 1, 2, 5, 5});
  EXPECT_EQ(knots.domain().lower, 0);
  EXPECT_EQ(knots.domain().upper, 2);
  EXPECT_EQ(knots.max_interior_multiplicity(), 1);
}

TEST(KnotVector, SpansAreTheNonEmptyOnesOfTheDomain) {
  EXPECT_EQ(testing::make_knots(1, {0, 0, 1, 1, 2, 3, 3}).spans(), (std::vector{1, 3, 4}));
  EXPECT_EQ(testing::make_knots(2, {-2, -1, 0, 1, 1, 2, 3}).spans(), (std::vector{2}));
}

TEST(KnotVector, GrevilleAbscissaeOfKnownVectors) {
  const auto knots = testing::make_knots(3, {0, 0, 0, 0, 1, 2, 3, 3, 3, 3});
  const std::vector<double> expected = {0, 1.0 / 3, 1, 2, 8.0 / 3, 3};
  for (int i = 0; i < knots.count(); ++i)
    EXPECT_DOUBLE_EQ(knots.greville(i), expected[static_cast<std::size_t>(i)]);
  EXPECT_EQ(testing::make_knots(3, {0.1, 0.1, 0.1, 0.1, 0.7, 0.7, 0.7, 0.7}).greville(3), 0.7);
}

class KnotFamilies : public ::testing::TestWithParam<int> {};

TEST_P(KnotFamilies, EveryParameterLiesInItsSpan) {
  for (const auto& [name, knots] : testing::knot_families(GetParam())) {
    const auto spans = knots.spans();
    const auto [a, b] = knots.domain();
    for (const int s : spans) {
      const double middle = std::midpoint(knots[s], knots[s + 1]);
      for (const double u : {knots[s], middle, std::nextafter(knots[s + 1], a), knots[s + 1]}) {
        for (const Side side : {Side::right, Side::left}) {
          const int found = knots.find_span(u, side);
          EXPECT_TRUE(std::ranges::binary_search(spans, found)) << name;
          EXPECT_LE(knots[found], u) << name;
          EXPECT_LE(u, knots[found + 1]) << name;
        }
      }
      EXPECT_EQ(knots.find_span(knots[s], Side::right), s) << name;
      EXPECT_EQ(knots.find_span(knots[s + 1], Side::left), s) << name;
    }
    EXPECT_EQ(knots.find_span(a, Side::left), spans.front()) << name;
    EXPECT_EQ(knots.find_span(b, Side::right), spans.back()) << name;
  }
}

TEST_P(KnotFamilies, GrevilleAbscissaeAscendWithinTheirSupport) {
  for (const auto& [name, knots] : testing::knot_families(GetParam())) {
    const int p = knots.degree();
    for (int i = 0; i < knots.count(); ++i) {
      EXPECT_LE(knots[i + 1], knots.greville(i)) << name;
      EXPECT_LE(knots.greville(i), knots[i + p]) << name;
      if (i > 0) {
        EXPECT_LE(knots.greville(i - 1), knots.greville(i)) << name;
      }
      if (knots[i + 1] == knots[i + p]) {
        EXPECT_EQ(knots.greville(i), knots[i + 1]) << name;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllDegrees, KnotFamilies, ::testing::Range(1, max_degree + 1));

}  // namespace
}  // namespace knead
