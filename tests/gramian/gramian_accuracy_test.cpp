// Against quadruple precision on every family of knot vectors.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "gramian/simd/kernels.hpp"
#include "knead/gramian/gramian.hpp"
#include "support/gramian_error.hpp"
#include "support/knot_families.hpp"
#include "support/listed_families.hpp"

namespace knead {
namespace {

using testing::Quad;
using testing::worst_error;

class OfDegree : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, OfDegree, ::testing::Range(1, detail::max_kernel_degree + 1));

// Above the kernels' degrees the recurrence is Gauss' points, and as exact as they are.
class OfHighDegree : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, OfHighDegree, ::testing::Values(16, max_degree));

TEST_P(OfHighDegree, every_term_is_right_to_3e_14_of_the_absolute_integral_on_every_family) {
  for (const auto& [name, knots] : testing::knot_families(GetParam())) {
    SCOPED_TRACE(name);
    EXPECT_EQ(used_gramian_method(knots, 0, 0, GramianMethod::recurrence), GramianMethod::gauss);
    const GramianSet set = *gramians(knots, GramianMethod::recurrence);
    EXPECT_LE(worst_error(set.g00, testing::quad_gramian(knots, 0, 0)), 3e-14) << "G00";
    EXPECT_LE(worst_error(set.g11, testing::quad_gramian(knots, 1, 1)), 3e-14) << "G11";
    EXPECT_LE(worst_error(set.g22, testing::quad_gramian(knots, 2, 2)), 3e-14) << "G22";
    EXPECT_LE(worst_error(set.g10, testing::quad_gramian(knots, 1, 0)), 3e-14) << "G10";
  }
}

TEST_P(OfDegree, gauss_is_right_to_1e_14_of_the_absolute_integral_on_every_family) {
  for (const auto& [name, knots] : testing::knot_families(GetParam())) {
    for (int a = 0; a <= 2; ++a) {
      for (int b = 0; b <= 2; ++b) {
        const testing::QuadGramian exact = testing::quad_gramian(knots, a, b);
        for (const GramianMethod method : {GramianMethod::gauss, GramianMethod::gauss_reduced}) {
          EXPECT_LE(worst_error(*gramian(knots, a, b, method), exact), 1e-14)
              << name << ", G" << a << b;
        }
      }
    }
  }
}

/// What is promised of 11 and 22, beside ∫|N_i^(a) N_j^(b)|.
double promised_bound(int p) { return p <= 7 ? 1e-14 : p <= 10 ? 3e-14 : 1e-13; }

/// The promise of the recurrence: 00 and 10 to 1e-14, 11 and 22 by degree.
void expect_promised_accuracy(const KnotVector& knots) {
  const int p = knots.degree();
  const double bound = promised_bound(p);
  const GramianSet set = *gramians(knots, GramianMethod::recurrence);
  const testing::QuadGramian g00 = testing::quad_gramian(knots, 0, 0),
                             g10 = testing::quad_gramian(knots, 1, 0);
  EXPECT_LE(worst_error(set.g00, g00), 1e-14) << "G00";
  EXPECT_LE(worst_error(set.g11, testing::quad_gramian(knots, 1, 1)), bound) << "G11";
  EXPECT_LE(worst_error(set.g22, testing::quad_gramian(knots, 2, 2)), bound) << "G22";
  EXPECT_LE(worst_error(set.g10, g10), 1e-14) << "G10";
  // Entries of 00 are integrals of non-negative functions: beside the absolute integral is beside
  // the entry itself. Those of 10 are promised entry by entry where no unclamped end cuts them.
  if (!knots.clamped()) return;
  for (int i = 0; i < g10.n; ++i) {
    for (int j = std::max(0, i - p); j <= std::min(g10.n - 1, i + p); ++j) {
      if (i == j || testing::magnitude(g10.value(i, j)) < testing::smallest_compared) continue;
      const Quad error = testing::magnitude(Quad(set.g10(i, j)) - g10.value(i, j));
      EXPECT_LE(static_cast<double>(error / testing::magnitude(g10.value(i, j))), 1e-14)
          << "G10 " << i << " " << j;
    }
  }
}

TEST_P(OfDegree, recurrence_is_as_exact_as_promised_on_every_family) {
  for (const auto& [name, knots] : testing::knot_families(GetParam())) {
    SCOPED_TRACE(name);
    expect_promised_accuracy(knots);
  }
}

TEST_P(OfDegree, recurrence_is_as_exact_as_promised_on_random_knots) {
  const int p = GetParam(), count = p <= 7 ? 300 : 100;
  for (int k = 0; k < count; ++k) {
    const unsigned seed = static_cast<unsigned>(1000 * p + k);
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    expect_promised_accuracy(testing::random_knots(random, p));
    if (HasFailure()) break;
  }
  std::cout << "seeds " << 1000 * p << " … " << 1000 * p + count - 1 << "\n";
}

TEST_P(OfDegree, recurrence_is_as_exact_as_promised_on_random_members_of_every_family) {
  const int p = GetParam();
  const unsigned count = p <= 7 ? 20 : 10, first = 100'000 * static_cast<unsigned>(p);
  for (std::size_t family = 0; family < testing::listed_families.size(); ++family) {
    for (unsigned k = 0; k < count; ++k) {
      const unsigned seed = first + 1000 * static_cast<unsigned>(family) + k;
      SCOPED_TRACE(std::string(testing::listed_families[family]) + ", seed " +
                   std::to_string(seed));
      std::mt19937_64 random(seed);
      expect_promised_accuracy(testing::random_member(random, p, family));
    }
  }
  std::cout << testing::listed_families.size() << " families, seeds " << first
            << " + 1000 family + 0 … " << count - 1 << "\n";
}

// The reference is made for windows of 4p + 4 knots: a function knows no knots but its own.
TEST_P(OfDegree, recurrence_is_as_exact_as_promised_on_thousands_of_spans) {
  const int p = GetParam(), spans = 3000;
  const double bound = promised_bound(p);
  std::mt19937_64 random(static_cast<unsigned>(p));
  std::cout << "seed " << p << "\n";
  std::vector<double> lengths(spans);
  for (double& length : lengths)
    length = std::pow(10.0, std::uniform_real_distribution<double>(-3, 3)(random));
  const KnotVector knots = testing::clamped_knots(p, testing::breaks_of(lengths));
  const GramianSet set = *gramians(knots, GramianMethod::recurrence);
  const auto all = knots.knots();
  for (int window = 0; window < 20; ++window) {
    const int size = 4 * p + 4, last = static_cast<int>(all.size()) - size;
    const int first = window == 0   ? 0
                      : window == 1 ? last
                                    : std::uniform_int_distribution<int>(0, last)(random);
    const KnotVector part =
        testing::make_knots(p, {all.begin() + first, all.begin() + first + size});
    const auto worst = [&](const BandMatrix& matrix, int a, int b) {
      const testing::QuadGramian exact = testing::quad_gramian(part, a, b);
      double error = 0;
      // Functions whose support the window's domain holds.
      for (int i = p; i < part.count() - p; ++i) {
        for (int j = std::max(p, i - p); j <= std::min(part.count() - p - 1, i + p); ++j) {
          const Quad difference = Quad(matrix(first + i, first + j)) - exact.value(i, j);
          // 10 entry by entry but for the diagonal, which vanishes.
          const Quad scale =
              a + b == 1 && i != j ? testing::magnitude(exact.value(i, j)) : exact.absolute(i, j);
          if (scale == 0) continue;
          error = std::max(error, static_cast<double>(testing::magnitude(difference) / scale));
        }
      }
      return error;
    };
    EXPECT_LE(worst(set.g00, 0, 0), 1e-14) << "window at knot " << first;
    EXPECT_LE(worst(set.g10, 1, 0), 1e-14) << "window at knot " << first;
    EXPECT_LE(worst(set.g11, 1, 1), bound) << "window at knot " << first;
    EXPECT_LE(worst(set.g22, 2, 2), bound) << "window at knot " << first;
  }
}

// The formula is exact; what is lost is lost in rounding, about a digit per degree beside the
// largest entry. From degree 8 on rounding leaves too little to be told from a wrong formula.
class OfLowDegree : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, OfLowDegree, ::testing::Range(1, 8));

TEST_P(OfLowDegree, analytic_is_right_on_ordinary_knots_of_every_multiplicity) {
  const int p = GetParam();
  for (const auto& family : testing::knot_families(p)) {
    if (!family.ordinary()) continue;
    for (int a = 0; a <= p; ++a) {
      for (int b = 0; b <= p; ++b) {
        const BandMatrix matrix = *gramian(family.knots, a, b, GramianMethod::analytic);
        EXPECT_LE(worst_error(matrix, testing::quad_gramian(family.knots, a, b), true),
                  1e-14 * std::pow(10, p - 1))
            << family.name << ", G" << a << b;
      }
    }
  }
}

TEST(DigitsLeft, TellsWhereTheAnalyticMethodCancels) {
  const auto uniform = *KnotVector::clamped_uniform(3, 8);
  const auto close = *KnotVector::create(3, {0, 0, 0, 0, 0.5, 0.5 + 1e-8, 0.5 + 2e-8, 1, 1, 1, 1});
  for (const auto& [knots, least, most] : {std::tuple{uniform, 10.0, 17.0}, {close, -100.0, 8.0}}) {
    const auto digits = digits_left(knots, 0, 0, *gramian(knots, 0, 0, GramianMethod::analytic));
    ASSERT_TRUE(digits);
    EXPECT_GE(*digits, least);
    EXPECT_LE(*digits, most);
  }
  EXPECT_EQ(*digits_left(uniform, 1, 1, *gramian(uniform, 1, 1)), 17);
}

}  // namespace
}  // namespace knead
