#include "knead/spline/spline.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>

#include "support/knot_families.hpp"
#include "support/numbers.hpp"

namespace knead {
namespace {

using testing::nan;

const KnotVector linear = testing::make_knots(1, {0, 0, 1, 1});
const KnotVector quadratic = testing::make_knots(2, {0, 0, 0, 1, 2, 2, 2});

Points counted(int rows) {
  Points points(rows, 3);
  for (int i = 0; i < rows; ++i) points.row(i) << i, 0.1 * i, -i;
  return points;
}

TEST(Spline, NetHasOneEntryPerFunctionAndDirection) {
  const auto curve = Curve::create({quadratic}, counted(4));
  const auto surface = Surface::create({linear, quadratic}, counted(8));
  const auto volume = Volume::create({linear, quadratic, linear}, counted(16));
  ASSERT_TRUE(curve && surface && volume);
  EXPECT_EQ(curve->net(), (std::array{4}));
  EXPECT_EQ(surface->net(), (std::array{2, 4}));
  EXPECT_EQ(volume->net(), (std::array{2, 4, 2}));
  EXPECT_EQ(volume->size(), 16);
}

TEST(Spline, KeepsControlPointsAndWeightsToTheLastBit) {
  Points points = counted(4);
  points(2, 1) = -0.0;
  points(3, 2) = 5e-324;
  const std::vector<double> weights = {1, 0.1, 1e-300, 3};
  const auto curve = Curve::create({quadratic}, points, weights);
  ASSERT_TRUE(curve);
  EXPECT_TRUE((curve->control_points().array() == points.array()).all());
  EXPECT_TRUE(std::signbit(curve->control_points()(2, 1)));
  EXPECT_TRUE(std::ranges::equal(curve->weights(), weights));
  EXPECT_TRUE(curve->rational());
  EXPECT_FALSE(Curve::create({quadratic}, points)->rational());
}

TEST(Spline, NumbersWhoseProductsOverflowAreRefusedWithPlaceAndValue) {
  for (const double large : {1.01e50, 1e150, 1e200, 1e300}) {
    Points points = counted(4);
    points(2, 1) = -large;
    const auto far = Curve::create({quadratic}, points);
    ASSERT_FALSE(far) << large;
    EXPECT_EQ(far.error().where, "control point 2");
    EXPECT_NE(far.error().message().find(fmt::format("coordinate {} is too large", large)),
              std::string::npos);
    EXPECT_NE(far.error().message().find("1e+50"), std::string::npos);
    const auto heavy = Curve::create({quadratic}, counted(4), {1, 1, 1, large});
    ASSERT_FALSE(heavy) << large;
    EXPECT_EQ(heavy.error().where, "control point 3");
    EXPECT_NE(heavy.error().message().find(fmt::format("the weight {} is too large", large)),
              std::string::npos);
    const auto long_domain =
        Curve::create({*KnotVector::create(1, {0, 0, large, large})}, counted(2));
    EXPECT_EQ(long_domain.error().where, "knot 3");
    EXPECT_FALSE(Curve::create({*KnotVector::create(1, {0, 0, 1 / large, 1 / large})}, counted(2)));
    EXPECT_FALSE(Curve::create({quadratic}, counted(4), std::vector<double>(4, 1 / large)));
  }
}

TEST(Spline, NumbersWithinTheRangeAndVanishingOnesAreKept) {
  for (const double number : {1e50, 1e6, 1e-6, 1e-50, 1e-300, 5e-324, 0.0}) {
    Points points = counted(4);
    points(2, 1) = number;
    EXPECT_TRUE(Curve::create({quadratic}, points)) << number;
    EXPECT_TRUE(Curve::create({quadratic}, counted(4), {1, number, 1, 1})) << number;
  }
  EXPECT_TRUE(Curve::create({quadratic}, counted(4), {1e-6, 1e6, 1e-6, 1e6}));
}

TEST(Spline, NetThatDoesNotFitTheKnotsIsRefused) {
  const auto surface = Surface::create({linear, quadratic}, counted(7));
  ASSERT_FALSE(surface);
  EXPECT_EQ(surface.error().what, "7 control points do not fit the knots");
  EXPECT_EQ(surface.error().remedy, "the knots ask for 8");
}

TEST(Spline, ControlPointThatIsNoNumberIsNamedByItsIndices) {
  Points points = counted(16);
  points(7, 2) = nan;
  EXPECT_EQ(Volume::create({linear, quadratic, linear}, points).error().where,
            "control point (0, 3, 1)");
  EXPECT_EQ(Surface::create({linear, quadratic}, points.topRows(8)).error().where,
            "control point (1, 3)");
  points(1, 0) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Curve::create({quadratic}, points.topRows(4)).error().where, "control point 1");
}

TEST(Spline, WeightsThatDoNotFitAreRefused) {
  const auto few = Curve::create({quadratic}, counted(4), {1, 1, 1});
  ASSERT_FALSE(few);
  EXPECT_EQ(few.error().what, "3 weights do not fit 4 control points");
  const auto bad = Surface::create({linear, linear}, counted(4), {1, 1, nan, 1});
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().where, "control point (1, 0)");
}

TEST(Spline, NegativeAndZeroWeightsAreKept) {
  const auto curve = Curve::create({quadratic}, counted(4), {1, -0.5, 0, 1});
  ASSERT_TRUE(curve);
  EXPECT_EQ(curve->weights()[1], -0.5);
  EXPECT_EQ(curve->weights()[2], 0);
}

TEST(Spline, OtherControlPointsKeepKnotsAndWeights) {
  const std::vector<double> weights = {1, 2, 3, 4};
  const auto curve = Curve::create({quadratic}, counted(4), weights);
  const auto moved = curve->with_control_points(2 * counted(4));
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->knots(0), quadratic);
  EXPECT_TRUE(std::ranges::equal(moved->weights(), weights));
  EXPECT_EQ(moved->control_points()(3, 0), 6);
  EXPECT_EQ(curve->control_points()(3, 0), 3);
  EXPECT_FALSE(curve->with_control_points(counted(5)));
}

}  // namespace
}  // namespace knead
