// Against quadruple precision on every family of knot vectors.
#include <gtest/gtest.h>

#include <cmath>

#include "knead/gramian/gramian.hpp"
#include "support/knot_families.hpp"
#include "support/quad_gramian.hpp"

namespace knead {
namespace {

using testing::Quad;

/// The largest error of an entry beside ∫|N_i^(a) N_j^(b)|, or beside the largest such integral of the matrix. Where
/// the functions do not overlap the entry must be zero. Entries below 1e-280 are left out: doubles lose digits there.
double worst_error(const BandMatrix& matrix, const testing::QuadGramian& exact, bool beside_largest = false) {
  Quad largest = 0;
  for (const Quad value : exact.absolutes) largest = std::max(largest, value);
  double worst = 0;
  for (int i = 0; i < exact.n; ++i) {
    for (int j = std::max(0, i - exact.p); j <= std::min(exact.n - 1, i + exact.p); ++j) {
      const Quad error = testing::magnitude(Quad(matrix(i, j)) - exact.value(i, j));
      const Quad scale = beside_largest ? largest : exact.absolute(i, j);
      if (error == 0 || (scale != 0 && scale < Quad(1e-280))) continue;
      worst = std::max(worst, scale == 0 ? INFINITY : static_cast<double>(error / scale));
    }
  }
  return worst;
}

class OfDegree : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, OfDegree, ::testing::Range(1, max_degree + 1));

TEST_P(OfDegree, gauss_is_right_to_1e_14_of_the_absolute_integral_on_every_family) {
  for (const auto& [name, knots] : testing::knot_families(GetParam())) {
    for (int a = 0; a <= 2; ++a) {
      for (int b = 0; b <= 2; ++b) {
        const BandMatrix matrix = *gramian(knots, a, b, GramianMethod::gauss);
        EXPECT_LE(worst_error(matrix, testing::quad_gramian(knots, a, b)), 1e-14) << name << ", G" << a << b;
      }
    }
  }
}

// The formula is exact; what is lost is lost in rounding, about a digit per degree beside the largest entry.
/// The promise of the recurrence: 00 and 10 to 1e-14, 11 and 22 by degree.
void expect_promised_accuracy(const KnotVector& knots) {
  const int p = knots.degree();
  const double bound = p <= 7 ? 1e-14 : p <= 10 ? 3e-14 : 1e-13;
  const GramianSet set = *gramians(knots, GramianMethod::recurrence);
  const testing::QuadGramian g00 = testing::quad_gramian(knots, 0, 0), g10 = testing::quad_gramian(knots, 1, 0);
  EXPECT_LE(worst_error(set.g00, g00), 1e-14) << "G00";
  EXPECT_LE(worst_error(set.g11, testing::quad_gramian(knots, 1, 1)), bound) << "G11";
  EXPECT_LE(worst_error(set.g22, testing::quad_gramian(knots, 2, 2)), bound) << "G22";
  EXPECT_LE(worst_error(set.g10, g10), 1e-14) << "G10";
  // Entries of 00 are integrals of non-negative functions: beside the absolute integral is beside the entry itself.
  // Those of 10 are promised entry by entry where no unclamped end cuts them.
  if (!knots.clamped()) return;
  for (int i = 0; i < g10.n; ++i) {
    for (int j = std::max(0, i - p); j <= std::min(g10.n - 1, i + p); ++j) {
      if (i == j || testing::magnitude(g10.value(i, j)) < Quad(1e-280)) continue;
      const Quad error = testing::magnitude(Quad(set.g10(i, j)) - g10.value(i, j));
      EXPECT_LE(static_cast<double>(error / testing::magnitude(g10.value(i, j))), 1e-14) << "G10 " << i << " " << j;
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
}

TEST(RecurrenceGramian, is_as_exact_as_promised_on_thousands_of_spans) {
  for (const int p : {2, 3, 9}) {
    std::mt19937_64 random(static_cast<unsigned>(p));
    std::vector<double> lengths(3000);
    for (double& length : lengths) length = std::pow(10.0, std::uniform_real_distribution<double>(-3, 3)(random));
    SCOPED_TRACE("degree and seed " + std::to_string(p));
    expect_promised_accuracy(testing::clamped_knots(p, testing::breaks_of(lengths)));
  }
}

// From degree 8 on rounding leaves too little to be told from a wrong formula.
class OfLowDegree : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, OfLowDegree, ::testing::Range(1, 8));

TEST_P(OfLowDegree, analytic_is_right_on_ordinary_knots_of_every_multiplicity) {
  const int p = GetParam();
  for (const auto& family : testing::knot_families(p)) {
    if (!family.ordinary()) continue;
    for (int a = 0; a <= 2; ++a) {
      for (int b = 0; b <= 2; ++b) {
        const BandMatrix matrix = *gramian(family.knots, a, b, GramianMethod::analytic);
        EXPECT_LE(worst_error(matrix, testing::quad_gramian(family.knots, a, b), true), 1e-14 * std::pow(10, p - 1))
            << family.name << ", G" << a << b;
      }
    }
  }
}

}  // namespace
}  // namespace knead
