#include "knead/energy/stiffness.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>

#include "energy/simd/tensor_kernels.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

using testing::random_points;

const Material general = {{1, 0.3, 0.5}, {1e-1, 2e-1, 5e-2}};

Stiffness<2> stiffness_of(const Surface& s, const Material& material,
                          StiffnessOptions options = {}) {
  auto made = Stiffness<2>::create(s, stretch_and_bend(material), options);
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

/// Surfaces of every kind: knots of all families in u against one of the same degree in v,
/// polynomial and rational.
std::vector<Surface> surfaces() {
  std::vector<Surface> result;
  for (int p : {1, 2, 3, 5}) {
    for (const auto& family : testing::knot_families(p)) {
      if (!family.ordinary() || family.knots.count() > 40) continue;
      result.push_back(testing::relief(family.knots, testing::uniform_clamped(p, 3), 7));
    }
  }
  result.push_back(testing::relief(testing::uniform_clamped(2, 4), testing::uniform_unclamped(3, 3),
                                   8, 0.1, 10));
  result.push_back(testing::cylinder());
  result.push_back(testing::sphere());
  return result;
}

TEST(Stiffness, HasTheCheckValuesOfThePublishedComparison) {
  // Open uniform knots on [0,1], p = 3, 128 x 128, all six terms.
  const auto knots = *KnotVector::clamped_uniform(3, 128);
  for (GramianMethod method :
       {GramianMethod::gauss, GramianMethod::analytic, default_gramian_method}) {
    const auto k = Stiffness<2>::create(
        {knots, knots}, stretch_and_bend({{1, 0.3, 0.5}, {1e-3, 2e-3, 5e-4}}), {.method = method});
    ASSERT_TRUE(k);
    const SparseMatrix matrix = k->assemble();
    EXPECT_EQ(matrix.nonZeros(), 781456);
    EXPECT_NEAR(matrix.norm(), 1.14119150436e4, 1e-7) << name(method);
  }
}

TEST(Stiffness, AppliedIsAssembledTimesVector) {
  for (const Surface& s : surfaces()) {
    const auto k = stiffness_of(s, general);
    const SparseMatrix matrix = k.assemble();
    const Points x = random_points(s.size(), 3), assembled = matrix * x, applied = k.apply(x);
    const Points absolute = matrix.cwiseAbs() * x.cwiseAbs();
    EXPECT_LE(((assembled - applied).array().abs() - 1e-14 * absolute.array()).maxCoeff(), 0);
    EXPECT_NEAR(k.energy(x), x.cwiseProduct(assembled).sum(),
                1e-13 * x.cwiseAbs().cwiseProduct(absolute).sum());
  }
}

TEST(Stiffness, ARefreshedMatrixIsAnAssembledOne) {
  for (const Surface& s : surfaces()) {
    SparseMatrix kept = stiffness_of(s, {{1, 0, 1}, {0, 0, 0}}).assemble();
    const double* const values = kept.valuePtr();
    const auto k = stiffness_of(s, general);
    k.refresh(kept);
    EXPECT_EQ((kept - k.assemble()).norm(), 0);
    EXPECT_EQ(kept.valuePtr(), values);
  }
}

TEST(Stiffness, RefreshWritesNothingBehindTheValues) {
  for (int p = 1; p <= 5; ++p) {
    const KnotVector line = testing::uniform_clamped(p, 1), two = testing::uniform_clamped(1, 2);
    const auto check = [](const auto& k) {
      SparseMatrix kept = k->assemble();
      const auto values = kept.nonZeros();
      constexpr Eigen::Index more = 64;
      kept.data().reserve(more);
      std::fill_n(kept.valuePtr() + values, more, 5);
      k->refresh(kept);
      EXPECT_TRUE(std::all_of(kept.valuePtr() + values, kept.valuePtr() + values + more,
                              [](double v) { return v == 5; }));
      EXPECT_EQ((kept - k->assemble()).norm(), 0);
    };
    check(Stiffness<1>::create({line}, mass_energy<1>()));
    check(Stiffness<2>::create({line, line}, mass_energy<2>()));
    check(Stiffness<2>::create({line, two}, mass_energy<2>()));
    check(Stiffness<3>::create({line, two, two}, mass_energy<3>()));
  }
}

TEST(Stiffness, SymmetricProductsGatherRows) {
  for (const Surface& s : surfaces()) {
    const SparseMatrix k = stiffness_of(s, general).assemble();
    const Points x = random_points(s.size(), 3), absolute = k.cwiseAbs() * x.cwiseAbs();
    EXPECT_LE(
        ((k * x - symmetric_product(k, x)).array().abs() - 1e-14 * absolute.array()).maxCoeff(), 0);
  }
}

TEST(Stiffness, IsSymmetricToTheLastBit) {
  for (const Surface& s : surfaces()) {
    const SparseMatrix k = stiffness_of(s, general).assemble();
    EXPECT_EQ((k - SparseMatrix(k.transpose())).norm(), 0);
  }
}

TEST(Stiffness, PatternIsTheWholeTensorBand) {
  const Surface s =
      testing::relief(testing::uniform_clamped(2, 5), testing::uniform_clamped(3, 4), 1);
  const auto [m, n] = s.net();
  EXPECT_EQ(stiffness_of(s, general).assemble().nonZeros(), (5 * m - 6) * (7 * n - 12));
  EXPECT_EQ(stiffness_of(s, {{1, 0, 1}, {0, 0, 0}}).assemble().nonZeros(),
            (5 * m - 6) * (7 * n - 12));
}

TEST(Stiffness, IsPositiveSemidefinite) {
  for (const Surface& s : surfaces()) {
    if (s.size() > 250) continue;
    const Eigen::MatrixXd k = stiffness_of(s, general).assemble();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k, Eigen::EigenvaluesOnly);
    EXPECT_GE(eigen.eigenvalues()(0), -1e-13 * eigen.eigenvalues().tail(1)(0));
  }
}

TEST(Stiffness, StretchAnnihilatesConstants) {
  for (const Surface& s : surfaces()) {
    const SparseMatrix k = stiffness_of(s, general).assemble();
    const Points constant = Points::Constant(s.size(), 3, 7.5);
    const Points bound = k.cwiseAbs() * constant;
    // The entries of a rational stiffness come from Gauss points, at every one of which the
    // derivatives of the basis sum to zero as well; 1e-12 leaves room for the cancellation in the
    // quotient rule.
    EXPECT_LE((k * constant).cwiseAbs().maxCoeff(), 1e-12 * bound.maxCoeff());
  }
}

TEST(Stiffness, BendAnnihilatesAffineMapsOfTheParameters) {
  for (int p : {2, 3, 4}) {
    for (const auto& family : testing::knot_families(p)) {
      if (!family.ordinary() || family.knots.count() > 60) continue;
      // S = (u, v, a + bu + cv): control points at the Greville abscissae.
      const KnotVector v = testing::uniform_clamped(p, 3);
      Points x(family.knots.count() * v.count(), 3);
      for (int i = 0; i < family.knots.count(); ++i) {
        for (int j = 0; j < v.count(); ++j) {
          const double gu = family.knots.greville(i), gv = v.greville(j);
          x.row(i * v.count() + j) << gu, gv, 1 + 2 * gu - 3 * gv;
        }
      }
      const auto k =
          Stiffness<2>::create({family.knots, v}, stretch_and_bend({{0, 0, 0}, {1, 1, 1}}));
      ASSERT_TRUE(k);
      const SparseMatrix matrix = k->assemble();
      const Points bound = matrix.cwiseAbs() * x.cwiseAbs();
      EXPECT_LE((matrix * x).cwiseAbs().maxCoeff(), 1e-13 * bound.maxCoeff()) << family.name;
    }
  }
}

TEST(Stiffness, WithoutMixedBendAnnihilatesTheProductOfParametersToo) {
  const KnotVector u = testing::uniform_clamped(3, 5), v = testing::uniform_clamped(2, 4);
  Points x(u.count() * v.count(), 3);
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j)
      x.row(i * v.count() + j).setConstant(u.greville(i) * v.greville(j));
  }
  const auto without = Stiffness<2>::create({u, v}, stretch_and_bend({{0, 0, 0}, {1, 0, 1}}));
  const auto with = Stiffness<2>::create({u, v}, stretch_and_bend({{0, 0, 0}, {1, 1, 1}}));
  EXPECT_NEAR(without->energy(x), 0, 1e-10);
  // ∫∫ 2 |S_uv|² over 5 x 4, in three coordinates.
  EXPECT_NEAR(with->energy(x), 3 * 2 * 20, 1e-10);
}

TEST(Stiffness, EnergyOfAPolynomialIsItsIntegral) {
  // S = (u², uv, v²) on [0,2] x [0,3], exact in degree 2: |S_u|² = 4u² + v², |S_v|² = u² + 4v²,
  // S_u·S_v = uv, |S_uu|² = 4, |S_uv|² = 1, |S_vv|² = 4.
  const KnotVector u = testing::clamped_knots(2, {0, 0.5, 2}),
                   v = testing::clamped_knots(2, {0, 1, 3}, {3, 2, 3});
  const auto square = [](const KnotVector& k, int i) {
    return k[i + 1] * k[i + 2];
  };  // blossom of t²
  Points x(u.count() * v.count(), 3);
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j) {
      x.row(i * v.count() + j) << square(u, i), u.greville(i) * v.greville(j), square(v, j);
    }
  }
  const double su = 8.0 / 3 * 3, sv = 27.0 / 3 * 2;  // ∫∫u², ∫∫v²
  const double uv = 2 * 4.5, one = 6;
  const Material m = {{1, 0.5, 2}, {3, 4, 5}};
  const double expected = m.alpha[0] * (4 * su + sv) + 2 * m.alpha[1] * uv +
                          m.alpha[2] * (su + 4 * sv) + m.beta[0] * 4 * one + 2 * m.beta[1] * one +
                          m.beta[2] * 4 * one;
  for (GramianMethod method :
       {GramianMethod::gauss, GramianMethod::analytic, default_gramian_method}) {
    const auto k = Stiffness<2>::create({u, v}, stretch_and_bend(m), {.method = method});
    EXPECT_NEAR(k->energy(x), expected, 1e-12 * expected);
  }
}

TEST(Stiffness, OfARationalSurfaceWithEqualWeightsIsThePolynomialOne) {
  const Surface plain = testing::relief(testing::uniform_clamped(3, 4),
                                        testing::clamped_knots(2, {0, 1, 4}, {3, 2, 3}), 5);
  const Surface weighted =
      testing::make_surface(plain.knots(0), plain.knots(1), plain.control_points(),
                            std::vector<double>(static_cast<std::size_t>(plain.size()), 0.25));
  const SparseMatrix a = stiffness_of(plain, general).assemble(),
                     b = stiffness_of(weighted, general).assemble();
  EXPECT_EQ(a.nonZeros(), b.nonZeros());
  EXPECT_LE((a - b).norm(), 1e-13 * a.norm());
}

TEST(Stiffness, OfACylinderIsTheIntegralOverTheCylinder) {
  // The quarter arc with weights (1, √½, 1) on [0,1]: the energies of the exact rational curve by
  // an independent composite Simpson rule on the known point function.
  const Surface s = testing::cylinder(2);
  const auto k = stiffness_of(s, {{1, 0, 0}, {0, 0, 0}});
  double reference = 0;
  constexpr int steps = 2000;
  for (int q = 0; q <= steps; ++q) {
    // (x, y) = ((1−t²), 2t...) is not this parametrisation; differentiate the quotient directly.
    const double t = static_cast<double>(q) / steps, r = std::sqrt(0.5), c = 1 - t;
    const double w = c * c + 2 * r * c * t + t * t, dw = -2 * c + 2 * r * (1 - 2 * t) + 2 * t;
    const double x = c * c + 2 * r * c * t, dx = -2 * c + 2 * r * (1 - 2 * t);
    const double y = 2 * r * c * t + t * t, dy = 2 * r * (1 - 2 * t) + 2 * t;
    const double sx = (dx * w - x * dw) / (w * w), sy = (dy * w - y * dw) / (w * w);
    reference += (q == 0 || q == steps ? 1
                  : q % 2 == 1         ? 4
                                       : 2) *
                 (sx * sx + sy * sy) / (3.0 * steps);
  }
  EXPECT_NEAR(k.energy(s.control_points()), 4 * reference, 1e-8 * reference);
}

TEST(Stiffness, NeverIgnoresWeights) {
  const Surface s =
      testing::relief(testing::uniform_clamped(2, 3), testing::uniform_clamped(2, 3), 4, 0.1, 1e3);
  const Surface plain = testing::make_surface(s.knots(0), s.knots(1), s.control_points());
  const SparseMatrix a = stiffness_of(s, general).assemble(),
                     b = stiffness_of(plain, general).assemble();
  EXPECT_GT((a - b).norm(), 0.1 * b.norm());
}

TEST(Stiffness, TakesWeightsFromAMillionthToAMillion) {
  const Surface s =
      testing::relief(testing::uniform_clamped(2, 3), testing::uniform_clamped(2, 3), 4, 0.1, 1e6);
  const auto k = stiffness_of(s, general);
  EXPECT_TRUE(std::isfinite(k.energy(s.control_points())));
  EXPECT_GT(k.energy(s.control_points()), 0);
}

TEST(Stiffness, RefusesADenominatorThatIsNotPositive) {
  Surface s = testing::sheet(testing::uniform_clamped(2, 1), testing::uniform_clamped(2, 1));
  std::vector<double> weights(9, 1.0);
  weights[4] = -10;
  const auto k = Stiffness<2>::create(
      testing::make_surface(s.knots(0), s.knots(1), s.control_points(), weights),
      stretch_and_bend({}));
  ASSERT_FALSE(k);
  EXPECT_EQ(k.error().kind, ErrorKind::numerical);
}

TEST(Stiffness, MassOfTheConstantOneIsTheAreaOfTheDomain) {
  for (const Surface& s : surfaces()) {
    const auto mass = Stiffness<2>::create(s, mass_energy<2>(2.5));
    ASSERT_TRUE(mass);
    const Points one = Points::Constant(s.size(), 3, 1.0);
    const double area = s.knots(0).domain().length() * s.knots(1).domain().length();
    EXPECT_NEAR(mass->energy(one), 3 * 2.5 * area, 1e-12 * 3 * 2.5 * area);
  }
}

TEST(Stiffness, OfCurvesAndVolumesIsTheSameCode) {
  // ∫ |C'|² of C = (t, t, t) on [0, 4], and ∫ |V_uvw|-free stretch of V = (u, v, w) on a box 2 x 1
  // x 3.
  const KnotVector t = testing::uniform_clamped(3, 4);
  Points line(t.count(), 3);
  for (int i = 0; i < t.count(); ++i) line.row(i).setConstant(t.greville(i));
  EXPECT_NEAR(Stiffness<1>::create({t}, {{1, {1}, {1}}})->energy(line), 12, 1e-12);

  const std::array<KnotVector, 3> box = {testing::uniform_clamped(1, 2),
                                         testing::uniform_clamped(2, 1),
                                         testing::uniform_clamped(3, 3)};
  Points v(box[0].count() * box[1].count() * box[2].count(), 3);
  int row = 0;
  for (int i = 0; i < box[0].count(); ++i) {
    for (int j = 0; j < box[1].count(); ++j) {
      for (int k = 0; k < box[2].count(); ++k)
        v.row(row++) << box[0].greville(i), box[1].greville(j), box[2].greville(k);
    }
  }
  const Energy<3> stretch = {
      {1, {1, 0, 0}, {1, 0, 0}}, {1, {0, 1, 0}, {0, 1, 0}}, {1, {0, 0, 1}, {0, 0, 1}}};
  const auto k = Stiffness<3>::create(box, stretch);
  EXPECT_NEAR(k->energy(v), 18, 1e-12);
  EXPECT_LE((k->assemble() * v - k->apply(v)).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Stiffness, RefusesThirdDerivatives) {
  const KnotVector t = testing::uniform_clamped(3, 4);
  const auto k = Stiffness<1>::create({t}, {{1, {3}, {3}}});
  ASSERT_FALSE(k);
  EXPECT_EQ(k.error().kind, ErrorKind::usage);
}

}  // namespace
}  // namespace knead
