#include "gramian/double_double.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "gramian/unit_gauss.hpp"
#include "support/quad_gramian.hpp"

namespace knead {
namespace {

using detail::DoubleDouble;

mpq_class rational(DoubleDouble x) { return mpq_class(x.high) + mpq_class(x.low); }

/// A number of 106 bits whose size is anything from 1e-30 to 1e30.
DoubleDouble random_number(std::mt19937_64& random) {
  std::uniform_real_distribution<double> mantissa(-1, 1), exponent(-100, 100);
  const double high = std::ldexp(mantissa(random), static_cast<int>(exponent(random)));
  return DoubleDouble::sum(high, std::ldexp(high, -54) * mantissa(random));
}

TEST(DoubleDouble, loses_nothing_of_sums_and_products_of_doubles) {
  std::mt19937_64 random(1);
  for (int k = 0; k < 2000; ++k) {
    const double a = random_number(random).high, b = random_number(random).high;
    EXPECT_EQ(rational(DoubleDouble::sum(a, b)), mpq_class(a) + mpq_class(b)) << a << " " << b;
    EXPECT_EQ(rational(DoubleDouble::product(a, b)), mpq_class(a) * mpq_class(b)) << a << " " << b;
  }
}

TEST(DoubleDouble, keeps_100_bits_of_every_operation_differences_of_equals_included) {
  std::mt19937_64 random(2);
  const mpq_class unit = mpq_class(1) / (mpz_class(1) << 100);
  const auto expect_near = [&](DoubleDouble computed, const mpq_class& exact) {
    EXPECT_LE(abs(rational(computed) - exact), unit * abs(exact)) << static_cast<double>(computed);
    EXPECT_EQ(computed.high + computed.low, computed.high);
  };
  for (int k = 0; k < 2000; ++k) {
    const DoubleDouble a = random_number(random), b = random_number(random),
                       close = {a.high, 0.25 * a.low};
    expect_near(a + b, rational(a) + rational(b));
    expect_near(a - b, rational(a) - rational(b));
    expect_near(a - close, rational(a) - rational(close));
    expect_near(a * b, rational(a) * rational(b));
    expect_near(a / b, rational(a) / rational(b));
    expect_near(b.high * a, rational(a) * mpq_class(b.high));
    expect_near(a / b.high, rational(a) / mpq_class(b.high));
  }
}

TEST(UnitGauss, is_correctly_rounded) {
  for (int n = 1; n <= detail::max_unit_gauss_points; ++n) {
    const auto rule = detail::unit_gauss<double>(n);
    const testing::QuadRule exact = testing::quad_rule(n);
    for (std::size_t k = 0; k < rule.t.size(); ++k) {
      const std::size_t mirrored = rule.t.size() - 1 - k;
      EXPECT_EQ(rule.t[k], static_cast<double>(exact.t[k])) << n << ": " << k;
      EXPECT_EQ(rule.complement[k], static_cast<double>(exact.t[mirrored])) << n << ": " << k;
      EXPECT_EQ(rule.weights[k], static_cast<double>(exact.weight[k])) << n << ": " << k;
    }
  }
}

}  // namespace
}  // namespace knead
