#include "knead/energy/paint.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "knead/energy/field_assembler.hpp"
#include "support/fields.hpp"

namespace knead {
namespace {

KnotVector knots(int p, int n, double a = 0, double b = 1) {
  return *KnotVector::clamped_uniform(p, n, a, b);
}

/// Largest |f − field| on a grid that has nothing to do with knots or samples.
double largest_error(const ParameterFunction<2>& f, const SplineField<2>& field, int n = 397) {
  std::vector<double> u[2];
  for (std::size_t d = 0; d < 2; ++d) {
    const auto [a, b] = field.knots()[d].domain();
    for (int k = 0; k <= n; ++k) u[d].push_back(std::min(a + (b - a) * k / n, b));
  }
  const std::vector<double> values = *field.on_grid({u[0], u[1]});
  double error = 0;
  for (std::size_t k = 0; k < u[0].size(); ++k) {
    for (std::size_t l = 0; l < u[1].size(); ++l) {
      error = std::max(error, std::abs(values[k * u[1].size() + l] - f({u[0][k], u[1][l]})));
    }
  }
  return error;
}

TEST(FitField, MeetsSmoothFunctionsToTheTolerance) {
  const ParameterFunction<2> f = [](const std::array<double, 2>& u) {
    return std::exp(-40 * (std::pow(u[0] - 0.3, 2) + std::pow(u[1] - 0.6, 2))) +
           std::sin(6 * u[0]) * u[1];
  };
  for (const int p : {1, 2, 3, 4}) {
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
      if (tolerance < 1e-4 && p < 3) continue;
      const auto fit = fit_field<2>(f, {knots(p, p + 1), knots(p, p + 3)}, {tolerance, 1 << 18});
      ASSERT_TRUE(fit) << p << " " << tolerance << " " << fit.error().message();
      EXPECT_LE(fit->error, tolerance);
      EXPECT_LE(largest_error(f, fit->field), tolerance) << p;
    }
  }
}

TEST(FitField, ReproducesWhatTheKnotsCanRepresent) {
  const auto field = testing::random_field<2>(
      {knots(3, 6), testing::clamped_knots(2, {0, 0.25, 1}, {3, 3, 3})}, 3);
  const auto fit = fit_field<2>([&](const std::array<double, 2>& u) { return *field.at(u); },
                                field.knots(), {1e-9});
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->field.knots()[0], field.knots()[0]);
}

TEST(FitField, RefinesOnlyTheDirectionThatNeedsIt) {
  const auto fit = fit_field<2>(
      [](const std::array<double, 2>& u) { return std::tanh(20 * (u[0] - 0.4)) + u[1]; },
      {knots(3, 4), knots(3, 4)}, {1e-4});
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->field.net()[1], 4);
  EXPECT_GT(fit->field.net()[0], 12);
}

TEST(FitField, WorksOnCurvesAndVolumes) {
  const auto curve = fit_field<1>([](const std::array<double, 1>& u) { return std::sqrt(u[0]); },
                                  {knots(3, 4)}, {1e-3});
  ASSERT_TRUE(curve) << curve.error().message();
  EXPECT_LE(curve->error, 1e-3);
  const auto volume =
      fit_field<3>([](const std::array<double, 3>& u) { return std::cos(u[0] + 2 * u[1] * u[2]); },
                   {knots(2, 3), knots(2, 3), knots(2, 3)}, {1e-3, 1 << 16, 24});
  ASSERT_TRUE(volume);
  EXPECT_NEAR(*volume->field.at({0.3, 0.7, 0.2}), std::cos(0.3 + 0.28), 1e-3);
}

TEST(FitField, SaysWhatItReachedWhereItCannotReachTheTolerance) {
  const auto jump = [](const std::array<double, 2>& u) { return u[0] + u[1] < 0.77 ? 0.0 : 1.0; };
  const auto fit = fit_field<2>(jump, {knots(3, 4), knots(3, 4)}, {1e-3, 3000});
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().kind, ErrorKind::numerical);
  EXPECT_NE(fit.error().what.find("met to"), std::string::npos);
  // In one direction the spans end before the coefficients do.
  const auto line = fit_field<1>(
      [](const std::array<double, 1>& u) { return u[0] < 0.7 ? 0.0 : 1.0; }, {knots(2, 3)}, {1e-3});
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().kind, ErrorKind::numerical);
}

TEST(FitField, RefusesValuesThatAreNotFinite) {
  const auto fit =
      fit_field<1>([](const std::array<double, 1>& u) { return 1 / (u[0] - 1); }, {knots(2, 3)});
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().where, "parameters (1)");
  EXPECT_FALSE(fit_field<1>([](const std::array<double, 1>&) { return 1.0; }, {knots(2, 3)}, {0}));
}

const std::array<Interval, 2> strip = {Interval{0, 1}, Interval{0, 1}};

Region<2> disc() {
  Region<2> r{ParameterBall<2>{{0.4, 0.6}, 0.2}, 0.15};
  r.factors = {2, 0.5};
  return r;
}

TEST(Region, IsOneInsideZeroBeyondItsFallOffAndSmoothBetween) {
  const Region<2> r = disc();
  EXPECT_EQ(r.weight({0.4, 0.6}, strip), 1);
  EXPECT_EQ(r.weight({0.49, 0.6}, strip), 1);
  EXPECT_EQ(r.weight({0.4, 0.99}, strip), 1);  // 0.195 of the arc length
  EXPECT_EQ(r.weight({0.58, 0.6}, strip), 0);
  const double middle = r.weight({0.4 + 0.275 / 2, 0.6}, strip);
  EXPECT_NEAR(middle, 0.5, 1e-14);
  Region<2> box{ParameterBox<2>{{0.2, 0.3}, {0.5, 0.4}}, 0.1};
  for (const Region<2>& region :
       {disc(), box}) {  // C1: slopes from either side agree at every point
    for (double t = 0.001; t < 1; t += 0.003) {
      const double h = 1e-5,
                   left = (region.weight({t, t}, strip) - region.weight({t - h, t - h}, strip)) / h,
                   right =
                       (region.weight({t + h, t + h}, strip) - region.weight({t, t}, strip)) / h;
      EXPECT_NEAR(left, right, 2e-2) << t;
    }
  }
}

TEST(Region, GoesTheShorterWayRoundWhereClosed) {
  Region<2> r{ParameterBall<2>{{0.05, 0.5}, 0.1}, 0.1};
  EXPECT_EQ(r.weight({0.99, 0.5}, strip), 0);
  r.closed = {true, false};
  EXPECT_EQ(r.weight({0.99, 0.5}, strip), 1);
  EXPECT_NEAR(r.weight({1, 0.5}, strip), r.weight({0, 0.5}, strip), 1e-15);
}

TEST(Paint, OnAConstantIsTheBlendToTheToleranceAndKeepsTheRange) {
  for (const Region<2>& region :
       {disc(), Region<2>{ParameterBox<2>{{0.2, 0.3}, {0.5, 1.0}}, 0.1}}) {
    const auto painted = paint<2>(2.0, 5.0, region, {knots(3, 6), knots(3, 6)}, {1e-3});
    ASSERT_TRUE(painted) << painted.error().message();
    EXPECT_GE(painted->range().lower, 2);
    EXPECT_LE(painted->range().upper, 5);
    EXPECT_LE(
        largest_error([&](const auto& u) { return 2 + 3 * region.weight(u, strip); }, *painted),
        3e-3);
  }
}

TEST(Paint, IsTheValueInsideAndTheOldOneFarFromTheRegionToTheLastBit) {
  Region<2> region{ParameterBox<2>{{0.3, 0.0}, {0.7, 1.0}}, 0.1};
  const auto painted = paint<2>(0.1, 0.7, region, {knots(3, 24), knots(3, 8)});
  ASSERT_TRUE(painted);
  for (const double v : {0.0, 0.37, 1.0}) {
    // Two spans of 1/21 away: no function that lives there reaches the fall-off. Sums of equal
    // coefficients round.
    EXPECT_NEAR(*painted->at({0.02, v}), 0.1, 1e-16);
    EXPECT_NEAR(*painted->at({0.5, v}), 0.7, 3e-16);
  }
  EXPECT_EQ(painted->coefficients().front(), 0.1);
  EXPECT_EQ(painted->coefficients()[painted->coefficients().size() / 2], 0.7);
  region.closed = {true, false};
  region.shape = ParameterBall<2>{{0.95, 0.5}, 0.2};
  const auto around = paint<2>(0.1, 0.7, region, {knots(3, 24), knots(3, 24)});
  ASSERT_TRUE(around);
  EXPECT_NEAR(*around->at({0.05, 0.5}), 0.7, 1e-3);
  EXPECT_NEAR(*around->at({0.5, 0.5}), 0.1, 1e-16);
}

TEST(Paint, OverAnotherStrokeBlendsTheValues) {
  const std::array<KnotVector, 2> hint = {knots(3, 6), knots(3, 6)};
  const SplineField<2> first = *paint<2>(2.0, 5.0, disc(), hint, {1e-2});
  const Region<2> second{ParameterBox<2>{{0.3, 0.5}, {0.45, 0.6}}, 0.2};
  const auto painted = paint<2>(first, 1.0, second, hint, {1e-2});
  ASSERT_TRUE(painted) << painted.error().message();
  EXPECT_GE(painted->range().lower, 1);
  EXPECT_LE(painted->range().upper, 5);
  const auto blend = [&](const std::array<double, 2>& u) {
    const double w = second.weight(u, strip);
    return (1 - w) * *first.at(u) + w;
  };
  EXPECT_LE(largest_error(blend, *painted, 101), 4e-2);
}

TEST(Paint, ConvexMaterialsStayConvex) {
  MaterialFieldOf<2> m(Material{{4, 1.9, 1}, {0.1, 0, 0.1}});
  const std::array<KnotVector, 2> hint = {knots(3, 6), knots(2, 5)};
  MaterialPaint<2> values;
  values.alpha = {1, -1.9, 4};
  values.beta[1] = 0.5;
  values.mass = 0;
  for (const Region<2>& region :
       {disc(), Region<2>{ParameterBox<2>{{0.2, 0.3}, {0.5, 0.4}}, 0.1}}) {
    auto painted = paint<2>(m, values, region, hint, {1e-2});
    ASSERT_TRUE(painted) << painted.error().message();
    m = std::move(*painted);
    values.alpha = {0, 0, 0};
  }
  EXPECT_TRUE(std::holds_alternative<double>(m.beta[0]));
  EXPECT_TRUE(std::holds_alternative<SplineField<2>>(m.mass));
  values.alpha = {std::nullopt, 10, std::nullopt};
  const auto bad = paint<2>(m, values, disc(), hint, {1e-2});
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().where.substr(0, 7), "alpha12");
}

TEST(Paint, RefusesRegionsWithoutSense) {
  const std::array<KnotVector, 2> hint = {knots(3, 6), knots(2, 5)};
  Region<2> r = disc();
  r.falloff = 0;
  EXPECT_EQ(paint<2>(1.0, 2.0, r, hint).error().where, "falloff");
  r.falloff = 1e-7;
  const auto narrow = paint<2>(1.0, 2.0, r, hint, {1e-3, 4000});
  ASSERT_FALSE(narrow);
  EXPECT_EQ(narrow.error().kind, ErrorKind::numerical);
}

}  // namespace
}  // namespace knead
