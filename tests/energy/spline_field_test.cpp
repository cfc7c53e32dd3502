#include "knead/energy/spline_field.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "spline/interpolation/greville_interpolation.hpp"
#include "support/fields.hpp"

namespace knead {
namespace {

using testing::random_field;

TEST(GrevilleInterpolation, GivesSplinesTheirCoefficientsBackOnEveryKindOfKnots) {
  for (const int p : {1, 2, 3, 5}) {
    for (const auto& [name, knots] : testing::knot_families(p)) {
      const auto made = GrevilleInterpolation::create(knots);
      ASSERT_TRUE(made) << name << ": " << made.error().message();
      const auto n = static_cast<std::size_t>(knots.count());
      std::vector<double> c(n);
      std::mt19937_64 random(5);
      for (double& x : c) x = std::uniform_real_distribution<double>(-1, 1)(random);
      std::vector<double> values(n);
      for (std::size_t i = 0; i < n; ++i) {
        EXPECT_TRUE(knots.domain().contains(made->abscissae()[i])) << name;
        for (int r = 0; r <= p; ++r) {
          values[i] += made->basis().row(static_cast<int>(i), 0)[r] *
                       c[static_cast<std::size_t>(made->basis().first[i] + r)];
        }
      }
      made->solve(values.data(), 1, 1);
      for (std::size_t i = 0; i < n; ++i) {
        const bool vanishes =
            knots[i + p + 1] <= knots.domain().lower || knots[i] >= knots.domain().upper;
        // Rounding times a condition number of at most a few hundred; unclamped ends, where
        // functions are small on the domain, and clusters whose distances are themselves rounded
        // cost more.
        const bool hard = !knots.clamped() || name.find("cluster") != name.npos ||
                          name.find("1e6") != name.npos || name.find("thesis") != name.npos ||
                          knots.domain().upper > 1e5;
        EXPECT_NEAR(values[i], vanishes ? 0 : c[i], hard ? 1e-7 : 1e-12) << name << " " << i;
      }
    }
  }
}

TEST(GrevilleInterpolation, TakesBothLimitsAtAFullBreak) {
  const KnotVector knots = testing::clamped_knots(2, {0, 1, 2}, {3, 3, 3});
  const auto made = GrevilleInterpolation::create(knots);
  const std::vector<double> expected = {0, 0.5, 1, 1, 1.5, 2};
  EXPECT_EQ(made->abscissae(), expected);
  EXPECT_EQ(made->basis().first, (std::vector<int>{0, 0, 0, 3, 3, 3}));
}

TEST(SplineField, RefusesWhatDoesNotFitItsKnots) {
  const KnotVector k = testing::uniform_clamped(2, 3);
  EXPECT_EQ(SplineField<1>::create({k}, std::vector<double>(4, 1.0)).error().kind,
            ErrorKind::input);
  std::vector<double> c(5, 1.0);
  c[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(SplineField<1>::create({k}, c).error().where, "coefficient 3");
}

TEST(SplineField, ThroughSamplesTakesThem) {
  const auto field =
      sampled_field<2>({Interval{0, 2}, Interval{-1, 1}}, {3, 2}, {1, 2, 3, 4, 5, 6});
  ASSERT_TRUE(field);
  EXPECT_EQ(*field->at({1, 1}), 4);
  EXPECT_EQ(*field->at({2, -1}), 5);
  EXPECT_NEAR(*field->at({0.5, 0}), 2.5, 1e-15);
  EXPECT_FALSE(field->at({2.1, 0}));
  EXPECT_FALSE(sampled_field<2>({Interval{0, 2}, Interval{-1, 1}}, {1, 2}, {1, 2}));
}

TEST(SplineField, OnCommonKnotsIsTheSameFunction) {
  for (const auto& [name, other] : testing::knot_families(3)) {
    if (name.find("cluster") != name.npos || name.find("ulp") != name.npos) continue;
    const Interval domain = other.domain();
    const KnotVector knot_vector =
        testing::clamped_knots(2,
                               {domain.lower, domain.lower + 0.3 * domain.length(),
                                domain.lower + 0.55 * domain.length(), domain.upper},
                               {3, 2, 3, 3});
    const auto field = random_field<1>({knot_vector}, 3);
    const std::array<KnotVector, 1> pair[2] = {{knot_vector}, {other}};
    const auto common = common_knots<1>(std::span<const std::array<KnotVector, 1>>(pair));
    ASSERT_TRUE(common) << name;
    const auto moved = on_knots<1>(field, *common);
    ASSERT_TRUE(moved) << name << moved.error().message();
    std::vector<double> at;
    for (int k = 0; k <= 1000; ++k)
      at.push_back(std::min(domain.lower + domain.length() * k / 1000, domain.upper));
    for (const Side side : {Side::left, Side::right}) {
      const auto a = *field.on_grid({at}, side), b = *moved->on_grid({at}, side);
      for (std::size_t k = 0; k < a.size(); ++k)
        EXPECT_NEAR(a[k], b[k], 1e-11) << name << " " << at[k];
    }
  }
}

TEST(SplineField, OnKnotsOfAnotherDomainIsRefused) {
  const auto field = random_field<1>({testing::uniform_clamped(2, 3)}, 3);
  EXPECT_FALSE(on_knots<1>(field, {testing::uniform_clamped(2, 4)}));
}

}  // namespace
}  // namespace knead
