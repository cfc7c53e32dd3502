#include <gtest/gtest.h>

#include <cmath>

#include "knead/energy/shell_energy.hpp"
#include "support/knot_families.hpp"
#include "support/numbers.hpp"
#include "support/surfaces.hpp"

// Shells whose thickness and Young's modulus vary.

namespace knead {
namespace {

using testing::epsilon;

/// Linear between samples along u, the same along v.
SplineField<2> along_u(const std::vector<double>& values) {
  std::vector<double> samples;
  for (const double x : values) samples.insert(samples.end(), 2, x);
  return *sampled_field<2>({Interval{0, 1}, Interval{0, 1}}, {static_cast<int>(values.size()), 2},
                           samples);
}

/// 2 × 1 on [0, 1]², on 3 × 2 spans: the samples below have their kinks within these.
const Surface plate = testing::uniform_sheet(3, 6, 5, 2, 1);

TEST(ShellField, ThatIsConstantIsTheConstant) {
  const Surface rest =
      testing::relief(testing::uniform_clamped(2, 4), testing::uniform_clamped(3, 3), 5, 0.2, 2);
  ShellMaterial material{3, 0.3, 0.05, 2}, field = material;
  const Interval u = rest.knots(0).domain(), v = rest.knots(1).domain();
  field.young_field = *sampled_field<2>({u, v}, {2, 2}, std::vector<double>(4, 3.0));
  field.thickness_field = *sampled_field<2>({u, v}, {2, 2}, std::vector<double>(4, 0.05));
  const auto a = ShellEnergy::create(rest, material, 6), b = ShellEnergy::create(rest, field, 6);
  ASSERT_TRUE(a && b);
  const Points x = rest.control_points() + 0.1 * testing::random_points(rest.size(), 7);
  // The points of both rules differ by rounding.
  EXPECT_NEAR(a->energy(x).sum(), b->energy(x).sum(), 1e-12 * a->energy(x).sum());
  EXPECT_LT((a->gradient(x) - b->gradient(x)).norm(), 1e-12 * a->gradient(x).norm());
  EXPECT_LT((a->hessian(x) - b->hessian(x)).norm(), 1e-12 * a->hessian(x).norm());
  EXPECT_LT((a->mass() - b->mass()).norm(), 1e-12 * a->mass().norm());
}

TEST(ShellField, StretchesAPlateByTheMeanOfItsThickness) {
  ShellMaterial material{3, 0.3, 1, 0};
  material.thickness_field = along_u({0.1, 0.4, 0.2});  // mean 0.275
  const auto energy = ShellEnergy::create(plate, material);
  ASSERT_TRUE(energy) << energy.error().message();
  Points x = plate.control_points();
  x.col(0) *= 1.1;
  const double strain = (1.1 * 1.1 - 1) / 2,
               exact = 0.5 * 3 / (1 - 0.09) * strain * strain * 2 * 0.275;
  EXPECT_NEAR(energy->energy(x).membrane, exact, 100 * epsilon * exact);
}

TEST(ShellField, BendsByTheIntegralOfYoungTimesThicknessCubed) {
  // E = 1 + u, t = 0.1 (1 + 3 u): ∫ E t³ du = 1e-3 ∫ (1 + u)(1 + 3u)³ du = 1e-3 · (1 + 10/2 + 36/3
  // + 54/4 + 27/5)
  ShellMaterial material{1, 0, 1, 0};
  material.young_field = along_u({1, 2});
  material.thickness_field = along_u({0.1, 0.4});
  const auto energy = ShellEnergy::create(plate, material);
  ASSERT_TRUE(energy) << energy.error().message();
  // z = c x²/2 with x = 2 u, as cubic functions of u have it: small, so that the curvature is c to
  // c² x².
  const KnotVector& k = plate.knots(0);
  const double c = 1e-6;
  Points x = plate.control_points();
  for (int i = 0; i < k.count(); ++i) {
    // The blossom of u² at the knots of function i.
    const double a = k[i + 1], b = k[i + 2], d = k[i + 3], square = (a * b + a * d + b * d) / 3;
    for (int j = 0; j < plate.net()[1]; ++j) x(i * plate.net()[1] + j, 2) = 2 * c * square;
  }
  const double exact = 0.5 * c * c * 2 * 1e-3 * (1 + 5 + 12 + 13.5 + 5.4) / 12;
  EXPECT_NEAR(energy->energy(x).bending, exact, 1e-9 * exact);
}

TEST(ShellField, WeighsAndMovesByItsThickness) {
  ShellMaterial material{3, 0.3, 1, 2};
  material.thickness_field = along_u({0.1, 0.4, 0.2});
  const ShellEnergy energy = *ShellEnergy::create(plate, material);
  const double mass = 2 * 0.275 * 2;  // density, mean thickness, area
  EXPECT_NEAR(energy.mass().sum(), mass, 100 * epsilon * mass);
  const Points weight = energy.weight(Point(0, 0, -3));
  EXPECT_NEAR(weight.col(2).sum(), -3 * mass, 300 * epsilon * mass);
  EXPECT_EQ(weight.leftCols<2>().cwiseAbs().maxCoeff(), 0);
}

TEST(ShellField, GivesStressesOfThePlace) {
  ShellMaterial material{3, 0, 1, 0};
  material.thickness_field = along_u({0.1, 0.3});
  Points x = plate.control_points();
  x.col(0) *= 1.1;
  const auto results = shell_results(plate, *plate.with_control_points(x), material,
                                     (Parameters<2>(2, 2) << 0, 0.5, 0.5, 0.5).finished());
  ASSERT_TRUE(results);
  const double strain = (1.1 * 1.1 - 1) / 2;
  EXPECT_NEAR((*results)[0].membrane[0], 3 * 0.1 * strain, 1e-13);
  EXPECT_NEAR((*results)[1].membrane[0], 3 * 0.2 * strain, 1e-13);
  EXPECT_NEAR((*results)[1].von_mises[0], 3 * strain, 1e-13);
}

TEST(ShellField, MustBePositiveOnTheDomainOfTheShape) {
  ShellMaterial material{3, 0, 1, 0};
  material.thickness_field = along_u({0.1, 0, 0.2});
  EXPECT_EQ(validated(material).error().where, "thickness: coefficient (1, 0)");
  material.thickness_field =
      *sampled_field<2>({Interval{0, 2}, Interval{0, 1}}, {2, 2}, {1, 1, 1, 1});
  EXPECT_EQ(ShellEnergy::create(plate, material).error().where, "thickness");
}

}  // namespace
}  // namespace knead
