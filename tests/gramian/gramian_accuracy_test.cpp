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
TEST_P(OfDegree, recurrence_is_as_exact_as_promised_on_every_family) {
  const int p = GetParam();
  const double bound = p <= 7 ? 1e-14 : p <= 10 ? 3e-14 : 1e-13;
  for (const auto& [name, knots] : testing::knot_families(p)) {
    const GramianSet set = *gramians(knots, GramianMethod::recurrence);
    EXPECT_LE(worst_error(set.g00, testing::quad_gramian(knots, 0, 0)), 1e-14) << name << ", G00";
    EXPECT_LE(worst_error(set.g11, testing::quad_gramian(knots, 1, 1)), bound) << name << ", G11";
    EXPECT_LE(worst_error(set.g22, testing::quad_gramian(knots, 2, 2)), bound) << name << ", G22";
    EXPECT_LE(worst_error(set.g10, testing::quad_gramian(knots, 1, 0)), 1e-14) << name << ", G10";
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
