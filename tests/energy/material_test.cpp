#include "knead/energy/energy.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace knead {
namespace {

TEST(Material, ConvexOnesAreAccepted) {
  EXPECT_TRUE(validated({}));
  EXPECT_TRUE(validated({{0, 0, 0}, {0, 0, 0}}));
  EXPECT_TRUE(validated({{4, -2, 1}, {0, 1, 0}}));
}

TEST(Material, OthersAreRefusedByName) {
  const auto place = [](const Material& m) { return validated(m).error().where; };
  EXPECT_EQ(place({{-1, 0, 1}, {0, 0, 0}}), "alpha11");
  EXPECT_EQ(place({{1, 0, -1}, {0, 0, 0}}), "alpha22");
  EXPECT_EQ(place({{1, 1.0000001, 1}, {0, 0, 0}}), "alpha12");
  EXPECT_EQ(place({{1, 0, 1}, {0, -1e-300, 0}}), "beta12");
  EXPECT_EQ(place({{1, 0, 1}, {0, 0, std::numeric_limits<double>::quiet_NaN()}}), "beta22");
  EXPECT_EQ(place({{std::numeric_limits<double>::infinity(), 0, 1}, {0, 0, 0}}), "alpha11");
}

TEST(Energy, OfEquation48HasTheCoefficientsOfItsDefinition) {
  const Energy<2> e = stretch_and_bend({{1, 0.3, 0.5}, {2, 3, 4}});
  const Energy<2> expected = {{1, {1, 0}, {1, 0}},   {0.3, {1, 0}, {0, 1}}, {0.3, {0, 1}, {1, 0}},
                              {0.5, {0, 1}, {0, 1}}, {2, {2, 0}, {2, 0}},   {6, {1, 1}, {1, 1}},
                              {4, {0, 2}, {0, 2}}};
  EXPECT_EQ(e, expected);
}

TEST(Energy, OfAThinPlateHasTheCoefficientsOfItsDefinition) {
  const Energy<2> expected = {{4, {2, 0}, {2, 0}},
                              {6, {1, 1}, {1, 1}},  // 2 (1 − ν) D
                              {1, {2, 0}, {0, 2}},
                              {1, {0, 2}, {2, 0}},
                              {4, {0, 2}, {0, 2}}};
  EXPECT_EQ(stretch_and_bend(thin_plate(4, 0.25)), expected);
  EXPECT_EQ(stretch_and_bend(thin_plate(4, 0)).size(), 3U);
  MaterialOf<3> solid{{1, 0, 0, 1, 0, 1}, {4, 0, 0, 9, 0, 1}, 0.5};
  const Energy<3> three = stretch_and_bend<3>(solid);
  EXPECT_EQ(std::ranges::count(three, EnergyTerm<3>{3, {2, 0, 0}, {0, 2, 0}}), 1);
  EXPECT_EQ(std::ranges::count(three, EnergyTerm<3>{1.5, {0, 0, 2}, {0, 2, 0}}), 1);
}

TEST(Energy, WithAPoissonsRatioIsConvexFromMinusOneToOne) {
  for (const double ratio : {-1.0, 0.5, 1.0})
    EXPECT_TRUE(validated(Material{{0, 0, 0}, {1, 0, 1}, ratio}));
  for (const double ratio : {-1.001, 1.001, std::numeric_limits<double>::quiet_NaN()}) {
    const auto refused = validated(Material{{0, 0, 0}, {1, 0, 1}, ratio});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "poisson");
  }
  MaterialOf<1> curve;
  curve.poisson = 0.1;
  EXPECT_FALSE(validated<1>(curve));
  MaterialOf<3> solid;
  solid.poisson = -0.5;
  EXPECT_TRUE(validated<3>(solid));
  solid.poisson = -0.51;
  EXPECT_FALSE(validated<3>(solid));
}

TEST(Energy, OnAScaledDomainFollowsTheChainRule) {
  // û = 2u, v̂ = 4v: du dv = dû dv̂ / 8, ∂/∂u = 2 ∂/∂û; written for the old knots the factors are
  // inverted.
  const Energy<2> scaled = on_scaled_domain<2>(
      {{1, {0, 0}, {0, 0}}, {1, {1, 0}, {1, 0}}, {1, {2, 0}, {2, 0}}, {1, {1, 1}, {1, 1}}}, {2, 4});
  EXPECT_EQ(scaled[0].coefficient, 8);
  EXPECT_EQ(scaled[1].coefficient, 2);
  EXPECT_EQ(scaled[2].coefficient, 0.5);
  EXPECT_EQ(scaled[3].coefficient, 0.125);
}

}  // namespace
}  // namespace knead
