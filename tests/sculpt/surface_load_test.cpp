#include "knead/sculpt/surface_load.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/surfaces.hpp"

namespace knead {
namespace {

const DomainScaling raw{};

/// A sphere so large that a sheet in z = 0 sees a plane: every point enters by the same depth along −z.
Tool half_space(double depth) {
  constexpr double radius = 1e7;
  return {"plane", {Point(0.5, 0.5, radius - depth), radius}, ToolMode::collision, 3, 1};
}

TEST(SurfaceLoad, OfAUniformPressureIsTheIntegralOfEveryBasisFunction) {
  // F_i = f ∫ N_i, and ∫ N_i = (x_{i+p+1} − x_i)/(p + 1) (thesis Theorem 5.2).
  for (const auto& family : testing::knot_families(3)) {
    if (!family.ordinary() || !family.knots.clamped() || family.knots.count() > 40) continue;
    const KnotVector v = testing::uniform_clamped(2, 3);
    const Surface s = testing::sheet(family.knots, v);
    const auto load = SurfaceLoad::create(s, raw, std::numeric_limits<double>::infinity());
    ASSERT_TRUE(load);
    const Tool tool = half_space(0.01);
    const auto state = load->evaluate(s.control_points(), {&tool, 1});
    for (int i = 0; i < family.knots.count(); ++i) {
      for (int j = 0; j < v.count(); ++j) {
        const double area = (family.knots[i + 4] - family.knots[i]) / 4 * (v[j + 3] - v[j]) / 3;
        EXPECT_NEAR(state.force()(i * v.count() + j, 2), -3 * 0.01 * area, 1e-6 * area) << family.name;
      }
    }
  }
}

TEST(SurfaceLoad, ForceIsMinusTheGradientOfThePotential) {
  for (const Surface& s :
       {testing::relief(testing::uniform_clamped(3, 3), testing::uniform_clamped(2, 4), 1),
        testing::relief(testing::uniform_clamped(2, 3), testing::uniform_clamped(2, 3), 2, 0.1, 5)}) {
    for (ToolMode mode : {ToolMode::collision, ToolMode::proximity}) {
      const Tool tool = {"ball", {Point(0.6, 0.4, 0.3), 0.35}, mode, 10, 0.3};
      const auto load = SurfaceLoad::create(s, {1, {0.7, 1.3}}, 0.3);
      ASSERT_TRUE(load);
      const Points x = s.control_points(), direction = testing::random_points(x.rows(), 4);
      const auto state = load->evaluate(x, {&tool, 1});
      EXPECT_GT(state.contacts(), 10U);
      constexpr double h = 1e-5;
      const double slope = (load->evaluate(x + h * direction, {&tool, 1}).potential() -
                            load->evaluate(x - h * direction, {&tool, 1}).potential()) /
                           (2 * h);
      EXPECT_NEAR(-state.force().cwiseProduct(direction).sum(), slope, 1e-4 * std::abs(slope));
    }
  }
}

TEST(SurfaceLoad, HessianIsSymmetricAndTheDerivativeOfTheForce) {
  const Surface s = testing::relief(testing::uniform_clamped(2, 4), testing::uniform_clamped(3, 4), 3, 0.1, 4);
  const Tool tool = {"ball", {Point(0.6, 0.4, 0.3), 0.35}, ToolMode::proximity, 10, 0.3};
  const auto load = SurfaceLoad::create(s, raw, 0.3);
  const auto state = load->evaluate(s.control_points(), {&tool, 1});
  const Points a = testing::random_points(s.size(), 5), b = testing::random_points(s.size(), 6);
  const double ab = a.cwiseProduct(load->apply_hessian(state, b)).sum();
  const double ba = b.cwiseProduct(load->apply_hessian(state, a)).sum();
  EXPECT_NEAR(ab, ba, 1e-13 * a.norm() * b.norm());
  constexpr double h = 1e-6;
  const Points slope = (load->evaluate(s.control_points() + h * a, {&tool, 1}).force() -
                        load->evaluate(s.control_points() - h * a, {&tool, 1}).force()) /
                       (2 * h);
  EXPECT_LE((slope + load->apply_hessian(state, a)).norm(), 1e-4 * slope.norm());
}

TEST(SurfaceLoad, UsesMorePointsForSmallerTools) {
  const Surface s = testing::uniform_sheet(3, 6, 6);
  const auto coarse = SurfaceLoad::create(s, raw, std::numeric_limits<double>::infinity());
  const auto fine = SurfaceLoad::create(s, raw, 0.02);
  EXPECT_EQ(coarse->points(), 12 * 12);
  EXPECT_GE(fine->points(), 300 * 300);  // six points per 0.02
}

TEST(SurfaceLoad, WithoutToolsIsZero) {
  const Surface s = testing::uniform_sheet(3, 6, 6);
  const auto state = SurfaceLoad::create(s, raw, 1)->evaluate(s.control_points(), {});
  EXPECT_EQ(state.force().norm(), 0);
  EXPECT_EQ(state.potential(), 0);
}

}  // namespace
}  // namespace knead
