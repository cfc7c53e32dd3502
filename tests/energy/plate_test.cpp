// The bend energy of thin plates, with Poisson's ratio.
#include <gtest/gtest.h>

#include "knead/energy/stiffness.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

TEST(ThinPlate, HasTheEnergyOfKirchhoff) {
  // Of a u² + b v² + c uv, exact in degree 2, on [0,2] x [0,3]: D ∫∫ 4 a² + 4 b² + 8 ν a b + 2 (1 −
  // ν) c².
  const KnotVector u = testing::clamped_knots(2, {0, 0.5, 2}),
                   v = testing::clamped_knots(2, {0, 1, 3}, {3, 2, 3});
  const auto square = [](const KnotVector& k, int i) {
    return k[i + 1] * k[i + 2];
  };  // blossom of t²
  const double rigidity = 3, poisson = 0.3, area = 6;
  const auto k = Stiffness<2>::create({u, v}, stretch_and_bend(thin_plate(rigidity, poisson)));
  const auto energy_of = [&](double a, double b, double c) {  // of a u² + b v² + c uv
    Points x = Points::Zero(u.count() * v.count(), 3);
    for (int i = 0; i < u.count(); ++i) {
      for (int j = 0; j < v.count(); ++j) {
        x(i * v.count() + j, 0) =
            a * square(u, i) + b * square(v, j) + c * u.greville(i) * v.greville(j);
      }
    }
    return k->energy(x) / (rigidity * area);
  };
  EXPECT_NEAR(energy_of(1, 0, 0), 4, 1e-12);
  EXPECT_NEAR(energy_of(1, 1, 0), 8 * (1 + poisson), 1e-12);
  EXPECT_NEAR(energy_of(1, -1, 0), 8 * (1 - poisson), 1e-12);
  EXPECT_NEAR(energy_of(0, 0, 1), 2 * (1 - poisson), 1e-12);
}

TEST(ThinPlate, ClampedAllRoundDoesNotDependOnPoissonsRatio) {
  // ∫ w_uu w_vv − w_uv² is a null Lagrangian: it depends on the boundary alone.
  const KnotVector u = testing::uniform_clamped(3, 6), v = testing::uniform_clamped(4, 7);
  Points x = testing::random_points(u.count() * v.count(), 3);
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j) {
      if (i > 1 && j > 1 && i < u.count() - 2 && j < v.count() - 2) continue;
      x.row(i * v.count() + j).setZero();
    }
  }
  const auto energy = [&](double poisson) {
    return Stiffness<2>::create({u, v}, stretch_and_bend(thin_plate(1, poisson)))->energy(x);
  };
  for (const double poisson : {-0.5, 0.3, 1.0})
    EXPECT_NEAR(energy(poisson), energy(0), 1e-12 * energy(0)) << poisson;
}

}  // namespace
}  // namespace knead
