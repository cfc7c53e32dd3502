#include "base/gauss_legendre.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/numbers.hpp"
#include "support/quad_gramian.hpp"

namespace knead {
namespace {

using testing::Quad;

using testing::epsilon;

double ulp(double x) { return std::nextafter(std::abs(x), INFINITY) - std::abs(x); }

class GaussLegendre : public ::testing::TestWithParam<int> {};

TEST_P(GaussLegendre, AbscissaeAscendInsideTheInterval) {
  const auto [x, w] = gauss_legendre(GetParam());
  ASSERT_EQ(x.size(), static_cast<std::size_t>(GetParam()));
  ASSERT_EQ(w.size(), x.size());
  EXPECT_TRUE(std::ranges::is_sorted(x, std::less_equal<>{}) || x.size() == 1);
  EXPECT_LT(-1, x.front());
  EXPECT_LT(x.back(), 1);
  EXPECT_GT(*std::ranges::min_element(w), 0);
}

TEST_P(GaussLegendre, RuleIsSymmetricToTheLastBit) {
  const auto [x, w] = gauss_legendre(GetParam());
  for (std::size_t k = 0; k < x.size(); ++k) {
    EXPECT_EQ(x[k], -x[x.size() - 1 - k]);
    EXPECT_EQ(w[k], w[x.size() - 1 - k]);
  }
}

TEST_P(GaussLegendre, MomentsUpToDegreeTwoNMinusOneAreExact) {
  const auto [x, w] = gauss_legendre(GetParam());
  const int n = GetParam();
  for (int degree = 0; degree < 2 * n; ++degree) {
    Quad sum = 0, size = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      Quad power = 1;
      for (int i = 0; i < degree; ++i) power *= x[k];
      sum += w[k] * power;
      size += w[k] * testing::magnitude(power);
    }
    const Quad exact = degree % 2 == 0 ? Quad(2) / (degree + 1) : Quad(0);
    // Weights and abscissae are off by their rounding to double, which the power multiplies by
    // `degree`.
    const double bound = epsilon * (1 + degree) * static_cast<double>(size);
    EXPECT_LE(static_cast<double>(testing::magnitude(sum - exact)), bound) << "degree " << degree;
  }
}

TEST_P(GaussLegendre, NumbersAreWithinOneUlpOfQuadruplePrecision) {
  const auto [x, w] = gauss_legendre(GetParam());
  const testing::QuadRule exact = testing::quad_rule(GetParam());  // on [0, 1]
  for (std::size_t k = 0; k < x.size(); ++k) {
    const Quad abscissa = 2 * exact.t[k] - 1, weight = 2 * exact.weight[k];
    EXPECT_LE(static_cast<double>(testing::magnitude(x[k] - abscissa)), ulp(x[k])) << k;
    EXPECT_LE(static_cast<double>(testing::magnitude(w[k] - weight)), ulp(w[k])) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(AllSizes, GaussLegendre, ::testing::Range(1, max_gauss_points + 1));

TEST(GaussLegendreRule, ErrorAtDegreeTwoNIsThePublishedOne) {
  for (int n = 1; n <= 20; ++n) {
    const auto [x, w] = gauss_legendre(n);
    double sum = 0;
    for (std::size_t k = 0; k < x.size(); ++k) sum += w[k] * std::pow(x[k], 2 * n);
    // ∫ x^2n less the rule: 2^(2n+1) (n!)^4 / ((2n+1) ((2n)!)^2) (Abramowitz & Stegun 25.4.30).
    double error = 2.0 / (2 * n + 1);
    for (int k = 1; k <= n; ++k) error *= std::pow(2.0 * k / (n + k), 2);
    EXPECT_NEAR(2.0 / (2 * n + 1) - sum, error, 8 * epsilon) << n;
  }
}

TEST(GaussLegendreRule, HasThePublishedValues) {  // Abramowitz & Stegun, Table 25.4
  EXPECT_EQ(gauss_legendre(1).abscissae[0], 0);
  EXPECT_EQ(gauss_legendre(1).weights[0], 2);
  EXPECT_DOUBLE_EQ(gauss_legendre(2).abscissae[1], 1 / std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(gauss_legendre(2).weights[1], 1);
  EXPECT_DOUBLE_EQ(gauss_legendre(3).abscissae[2], std::sqrt(0.6));
  EXPECT_DOUBLE_EQ(gauss_legendre(3).weights[1], 8.0 / 9);
  EXPECT_DOUBLE_EQ(gauss_legendre(3).weights[2], 5.0 / 9);
  EXPECT_DOUBLE_EQ(gauss_legendre(10).abscissae[9], 0.973906528517171720);
  EXPECT_DOUBLE_EQ(gauss_legendre(10).weights[9], 0.066671344308688138);
}

}  // namespace
}  // namespace knead
