#include "knead/energy/field_assembler.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "support/fields.hpp"
#include "support/quad_gramian.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

using testing::random_field;

template <int D>
Spline<D> make_spline(const std::array<KnotVector, D>& knots, double weight_spread = 1) {
  int n = 1;
  for (const KnotVector& k : knots) n *= k.count();
  std::vector<double> weights;
  std::mt19937_64 random(3);
  for (int i = 0; weight_spread > 1 && i < n; ++i) {
    weights.push_back(
        std::pow(weight_spread, std::uniform_real_distribution<double>(-1, 1)(random)));
  }
  return *Spline<D>::create(knots, testing::random_points(n, 2), weights);
}

template <int D>
SparseMatrix assemble(const Spline<D>& spline, const FieldEnergy<D>& energy,
                      double tolerance = 1e-13) {
  auto made =
      FieldAssembler<D>(spline, {.method = GramianMethod::gauss, .rational_tolerance = tolerance})
          .assemble(energy);
  if (!made) {
    ADD_FAILURE() << made.error().message();
    return {};
  }
  return std::move(*made);
}

template <int D>
FieldEnergy<D> whole(const MaterialFieldOf<D>& m) {
  FieldEnergy<D> e = stretch_energy<D>(m);
  for (const auto& term : bend_energy<D>(m)) e.push_back(term);
  for (const auto& term : weighted_mass_energy<D>(m.mass)) e.push_back(term);
  return e;
}

/// A convex material of fields on the given knots.
template <int D>
MaterialFieldOf<D> random_material(const std::array<KnotVector, D>& knots, unsigned seed) {
  MaterialFieldOf<D> m;
  for (int i = 0; i < D; ++i) {
    for (int j = i; j < D; ++j) {
      const std::size_t k = MaterialOf<D>::place(i, j);
      m.alpha[k] = random_field<D>(knots, ++seed, i == j ? 0.9 : -0.4, i == j ? 2.0 : 0.4);
      m.beta[k] = random_field<D>(knots, ++seed, 0, 0.3);
    }
  }
  m.mass = random_field<D>(knots, ++seed, 0, 1);
  m.damping = random_field<D>(knots, ++seed, 0, 1);
  return m;
}

/// ∫ c ∂^a R_i ∂^b R_j by plain Gauss on every piece that the knots of field and spline make: an
/// independent, slow loop.
template <int D>
Eigen::MatrixXd reference(const Spline<D>& spline, const FieldEnergy<D>& energy, int points) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(spline.size(), spline.size());
  for (const FieldTerm<D>& term : energy) {
    std::array<Eigen::MatrixXd, D> left, right;  // function × point
    std::array<std::vector<double>, D> at, weight;
    const auto* field = std::get_if<SplineField<D>>(&term.coefficient);
    for (std::size_t d = 0; d < D; ++d) {
      const KnotVector& k = spline.knots()[d];
      const auto [lower, upper] = k.domain();
      std::vector<double> breaks(k.knots().begin(), k.knots().end());
      if (field)
        breaks.insert(breaks.end(), field->knots()[d].knots().begin(),
                      field->knots()[d].knots().end());
      std::ranges::sort(breaks);
      std::erase_if(breaks, [&, a = lower, b = upper](double x) { return x < a || x > b; });
      breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
      const testing::QuadRule rule = testing::quad_rule(points);
      for (std::size_t s = 0; s + 1 < breaks.size(); ++s) {
        for (std::size_t g = 0; g < rule.t.size(); ++g) {
          at[d].push_back(breaks[s] + (breaks[s + 1] - breaks[s]) * static_cast<double>(rule.t[g]));
          weight[d].push_back((breaks[s + 1] - breaks[s]) * static_cast<double>(rule.weight[g]));
        }
      }
      const BasisTable table = *tabulate_basis(k, at[d], 2);
      left[d] = right[d] = Eigen::MatrixXd::Zero(k.count(), table.size());
      for (int q = 0; q < table.size(); ++q) {
        for (int r = 0; r <= k.degree(); ++r) {
          left[d](table.first[static_cast<std::size_t>(q)] + r, q) = table.row(q, term.a[d])[r];
          right[d](table.first[static_cast<std::size_t>(q)] + r, q) = table.row(q, term.b[d])[r];
        }
      }
    }
    std::array<std::span<const double>, D> parameters;
    std::size_t total = 1;
    for (std::size_t d = 0; d < D; ++d) parameters[d] = at[d], total *= at[d].size();
    const std::vector<double> c =
        field ? *field->on_grid(parameters)
              : std::vector<double>(total, std::get<double>(term.coefficient));
    Eigen::MatrixXd f(spline.size(), static_cast<Eigen::Index>(total)), g = f;
    for (std::size_t q = 0; q < total; ++q) {
      for (int i = 0; i < spline.size(); ++i) {
        double product_f = term.factor * c[q], product_g = 1;
        std::size_t rest = q;
        int index = i;
        for (std::size_t d = D; d-- > 0;) {
          const auto n = spline.knots()[d].count();
          const auto k = static_cast<Eigen::Index>(rest % at[d].size());
          product_f *= left[d](index % n, k) * weight[d][rest % at[d].size()];
          product_g *= right[d](index % n, k);
          rest /= at[d].size();
          index /= n;
        }
        f(i, static_cast<Eigen::Index>(q)) = product_f;
        g(i, static_cast<Eigen::Index>(q)) = product_g;
      }
    }
    matrix += f * g.transpose();
  }
  return matrix;
}

template <int D>
void expect_equal(const SparseMatrix& a, const Eigen::MatrixXd& b, double tolerance,
                  const std::string& what) {
  // Entries are compared to the sizes of the functions they belong to: some are differences that
  // nearly cancel.
  const Eigen::VectorXd size = b.diagonal().cwiseAbs().cwiseSqrt();
  const Eigen::MatrixXd difference = (Eigen::MatrixXd(a) - b).cwiseAbs();
  const Eigen::MatrixXd allowed = tolerance * (size * size.transpose()).array() + 1e-300;
  EXPECT_LE((difference.array() / allowed.array()).maxCoeff(), 1) << what;
}

KnotVector short_knots(int p) {
  return testing::clamped_knots(p, {0, 1, 1.5, 3, 4}, {0, 1, p, 1, 0});
}
KnotVector field_knots(int q) {
  return testing::clamped_knots(q, {0, 0.7, 1.5, 2.2, 4}, {0, 1, q + 1, 1, 0});
}

TEST(FieldAssembler, WithConstantsIsStiffnessToTheLastBit) {
  const Surface s = testing::relief(short_knots(3), testing::uniform_unclamped(2, 4), 1);
  const Material m = {{1, 0.3, 0.5}, {0.1, 0.2, 0.05}, 0.3};
  FieldEnergy<2> energy = stretch_energy<2>(MaterialFieldOf<2>(m));
  for (const auto& term : bend_energy<2>(MaterialFieldOf<2>(m))) energy.push_back(term);
  const SparseMatrix expected = Stiffness<2>::create(s, stretch_and_bend(m),
                                                     {.method = GramianMethod::gauss})
                                    ->assemble(),
                     got = assemble<2>(s, energy);
  EXPECT_EQ((expected - got).norm(), 0);
  EXPECT_EQ(expected.nonZeros(), got.nonZeros());
}

template <int D>
void constant_fields(const std::array<KnotVector, D>& knots,
                     const std::array<KnotVector, D>& field) {
  const Spline<D> s = make_spline<D>(knots);
  MaterialOf<D> m;
  for (std::size_t k = 0; k < m.alpha.size(); ++k)
    m.alpha[k] = 1.0 / (1.0 + k), m.beta[k] = 0.1 / (2.0 + k);
  MaterialFieldOf<D> varying(m);
  for (auto* list : {&varying.alpha, &varying.beta}) {
    for (auto& c : *list) c = *on_knots<D>(c, field);
  }
  varying.mass = *on_knots<D>(2.0, field);
  std::array<double, D> factors;
  for (std::size_t d = 0; d < D; ++d) factors[d] = 0.5 + 1.7 * d;
  FieldAssembler<D> assembler(s);
  const auto got = assembler.assemble(varying, factors);
  ASSERT_TRUE(got) << got.error().message();
  const SparseMatrix k = got->stretch + got->bend;
  const SparseMatrix expected =
      Stiffness<D>::create(s, on_scaled_domain<D>(stretch_and_bend<D>(m), factors))->assemble();
  expect_equal<D>(k, expected, 1e-13, "stiffness");
  const SparseMatrix mass =
      Stiffness<D>::create(s, on_scaled_domain<D>(mass_energy<D>(2), factors))->assemble();
  expect_equal<D>(got->mass, mass, 1e-13, "mass");
  expect_equal<D>(got->damping, 0.25 * mass, 1e-13, "damping");
  EXPECT_EQ(k.nonZeros(), expected.nonZeros());
}

TEST(FieldAssembler, WithFieldsThatAreConstantIsStiffnessToRounding) {
  constant_fields<1>({short_knots(3)}, {field_knots(2)});
  constant_fields<2>({short_knots(3), testing::clamped_knots(2, {0, 1, 3})},
                     {field_knots(1), testing::clamped_knots(4, {0, 2, 3})});
  constant_fields<3>(
      {short_knots(2), testing::uniform_clamped(1, 2), testing::uniform_clamped(3, 2)},
      {field_knots(1), testing::uniform_clamped(2, 2), testing::clamped_knots(1, {0, 0.5, 2})});
}

TEST(FieldAssembler, OfAPlateThatVariesIsItsIntegral) {
  const std::array<KnotVector, 2> field = {field_knots(2), field_knots(1)};
  const Surface s = make_spline<2>({short_knots(3), short_knots(2)});
  MaterialFieldOf<2> plate(thin_plate(1, 0.3));
  const SplineField<2> rigidity = random_field<2>(field, 7, 0.5, 2);
  plate.beta = {rigidity, 0.0, rigidity};
  ASSERT_TRUE(validated<2>(plate));
  FieldEnergy<2> expected = {{1, rigidity, {2, 0}, {2, 0}},
                             {1, rigidity, {0, 2}, {0, 2}},
                             {0.3, rigidity, {2, 0}, {0, 2}},
                             {0.3, rigidity, {0, 2}, {2, 0}}};
  expect_equal<2>(assemble<2>(s, bend_energy<2>(plate)), reference<2>(s, expected, 8).sparseView(),
                  1e-12, "plate");
  // What is not the same in all directions has no such coefficient.
  plate.beta[2] = random_field<2>(field, 8, 0.5, 2);
  const auto refused = validated<2>(plate);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().where, "poisson");
}

TEST(FieldAssembler, IsTheIntegralForFieldsOfOtherDegreesAndKnots) {
  for (const int p : {1, 2, 3, 4}) {
    for (const int q : {1, 2, 3}) {
      const std::array<KnotVector, 2> knots = {short_knots(p),
                                               testing::clamped_knots(2, {0, 1, 1 + 1e-7, 2})};
      const std::array<KnotVector, 2> field = {field_knots(q),
                                               testing::clamped_knots(q, {0, 0.4, 2})};
      const Spline<2> s = make_spline<2>(knots);
      const FieldEnergy<2> e = whole<2>(random_material<2>(field, 7));
      expect_equal<2>(assemble<2>(s, e), reference<2>(s, e, p + q + 3), 1e-12,
                      std::to_string(p) + " " + std::to_string(q));
    }
  }
}

TEST(FieldAssembler, IsTheIntegralOnCurvesAndVolumes) {
  for (const auto& family : testing::knot_families(3)) {
    if (!family.ordinary() || family.knots.count() > 40) continue;
    const auto [lower, upper] = family.knots.domain();
    const KnotVector field =
        testing::clamped_knots(2, {lower, lower + 0.37 * (upper - lower), upper});
    const Spline<1> s = make_spline<1>({family.knots});
    const FieldEnergy<1> e = whole<1>(random_material<1>({field}, 2));
    // The reference rounds its parameters: on a short span far from zero that is a large part of
    // the span.
    double shortest = upper - lower;
    for (const int span : family.knots.spans())
      shortest = std::min(shortest, family.knots[span + 1] - family.knots[span]);
    const double moved = 1e-16 * std::max(std::abs(lower), std::abs(upper)) / shortest;
    expect_equal<1>(assemble<1>(s, e), reference<1>(s, e, 8), 1e-12 + 100 * moved, family.name);
  }
  const Spline<3> s =
      make_spline<3>({testing::uniform_clamped(2, 2), testing::clamped_knots(1, {0, 1, 3}),
                      testing::uniform_unclamped(3, 1)});
  const Interval last = s.knots(2).domain();
  const FieldEnergy<3> e = whole<3>(
      random_material<3>({testing::clamped_knots(1, {0, 0.6, 2}), testing::clamped_knots(2, {0, 3}),
                          testing::clamped_knots(2, {last.lower, last.upper})},
                         4));
  expect_equal<3>(assemble<3>(s, e), reference<3>(s, e, 6), 1e-12, "volume");
}

TEST(FieldAssembler, IsSymmetricToTheLastBitAndPositiveSemidefinite) {
  const std::array<KnotVector, 2> field = {field_knots(2), testing::clamped_knots(3, {0, 0.4, 2})};
  for (const double spread : {1.0, 10.0}) {
    const Spline<2> s = make_spline<2>({short_knots(3), testing::uniform_clamped(2, 2)}, spread);
    const MaterialFieldOf<2> m = random_material<2>(field, 5);
    ASSERT_TRUE(validated<2>(m));
    FieldAssembler<2> assembler(s);
    const auto made = assembler.assemble(m, {0.7, 1.9});
    ASSERT_TRUE(made);
    for (const SparseMatrix& k : {made->stretch, made->bend, made->mass, made->damping}) {
      EXPECT_EQ((k - SparseMatrix(k.transpose())).norm(), 0);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd(k),
                                                                 Eigen::EigenvaluesOnly);
      EXPECT_GE(eigen.eigenvalues()(0), -1e-13 * eigen.eigenvalues().tail(1)(0));
    }
    const Points constant = Points::Constant(s.size(), 3, 2.5);
    EXPECT_LE((made->stretch * constant).cwiseAbs().maxCoeff(),
              1e-11 * Eigen::MatrixXd(made->stretch).cwiseAbs().maxCoeff());
  }
}

TEST(FieldAssembler, IsLinearInTheField) {
  const std::array<KnotVector, 2> knots = {field_knots(2), testing::clamped_knots(1, {0, 0.5, 2})};
  const Spline<2> s = make_spline<2>({short_knots(3), testing::uniform_clamped(2, 2)});
  const SplineField<2> a = random_field<2>(knots, 1), b = random_field<2>(knots, 2);
  std::vector<double> sum(a.coefficients().size());
  for (std::size_t k = 0; k < sum.size(); ++k)
    sum[k] = 2 * a.coefficients()[k] - 3 * b.coefficients()[k];
  const auto with = [&](const SplineField<2>& f) {
    return assemble<2>(s, {{1, f, {1, 0}, {0, 1}}, {1, f, {0, 1}, {1, 0}}, {1, f, {2, 0}, {2, 0}}});
  };
  const SparseMatrix ka = with(a), kb = with(b);
  const SparseMatrix difference = with(testing::make_field<2>(knots, sum)) - (2 * ka - 3 * kb);
  EXPECT_LE(difference.norm(), 1e-14 * (2 * ka.norm() + 3 * kb.norm()));
}

TEST(FieldAssembler, OnARationalSplineWithEqualWeightsIsThePolynomialOne) {
  const Spline<2> plain = make_spline<2>({short_knots(3), testing::uniform_clamped(2, 2)});
  const Spline<2> weighted =
      *Spline<2>::create(plain.knots(), plain.control_points(),
                         std::vector<double>(static_cast<std::size_t>(plain.size()), 0.25));
  const FieldEnergy<2> e = whole<2>(
      random_material<2>({field_knots(3), testing::clamped_knots(2, {0, 0.5, 2}, {0, 3, 0})}, 5));
  const SparseMatrix a = assemble<2>(plain, e), b = assemble<2>(weighted, e);
  EXPECT_EQ(a.nonZeros(), b.nonZeros());
  expect_equal<2>(b, a, 1e-12, "equal weights");
  // Constants and fields that are constant agree on a spline whose weights vary.
  const Spline<2> rational = make_spline<2>({short_knots(3), testing::uniform_clamped(2, 2)}, 3);
  const FieldEnergy<2> constant = weighted_mass_energy<2>(3.0),
                       varying = weighted_mass_energy<2>(
                           *on_knots<2>(3.0, {short_knots(1), testing::uniform_clamped(1, 2)}));
  expect_equal<2>(assemble<2>(rational, varying), assemble<2>(rational, constant), 1e-12,
                  "constant field");
}

TEST(FieldAssembler, KeepsItsTriplesWithoutAChangeOfTheResult) {
  const Spline<2> s = make_spline<2>({short_knots(3), testing::uniform_clamped(2, 2)});
  FieldAssembler<2> kept(s);
  for (unsigned seed = 0; seed < 4; ++seed) {
    const auto m =
        random_material<2>({field_knots(1 + seed % 2), testing::uniform_clamped(2, 2)}, seed);
    const auto a = kept.assemble(m, {1, 2}), b = FieldAssembler<2>(s).assemble(m, {1, 2});
    EXPECT_EQ(
        (a->stretch - b->stretch).norm() + (a->bend - b->bend).norm() + (a->mass - b->mass).norm(),
        0);
  }
}

TEST(FieldAssembler, RefusesFieldsOverAnotherDomain) {
  const auto field = random_field<2>({field_knots(2), testing::uniform_clamped(2, 3)}, 1);
  for (const double spread : {1.0, 2.0}) {
    const Spline<2> s = make_spline<2>({short_knots(3), testing::uniform_clamped(2, 2)}, spread);
    const auto made = FieldAssembler<2>(s).assemble(weighted_mass_energy<2>(field));
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().kind, ErrorKind::input);
  }
}

TEST(MaterialField, ConvexityIsCheckedCoefficientByCoefficient) {
  const std::array<KnotVector, 2> k = {field_knots(2), testing::uniform_clamped(1, 3)};
  const std::array<KnotVector, 2> other = {short_knots(1), testing::uniform_clamped(2, 3)};
  const auto place = [](const MaterialFieldOf<2>& m) {
    const auto ok = validated<2>(m);
    return ok ? std::string() : ok.error().where;
  };
  MaterialFieldOf<2> m = random_material<2>(k, 1);
  EXPECT_EQ(place(m), "");
  m.alpha[1] = random_field<2>(other, 1, -0.4, 0.4);
  EXPECT_EQ(place(m), "");
  m.alpha[1] = random_field<2>(other, 1, 2.1, 2.2);
  EXPECT_EQ(place(m).substr(0, 7), "alpha12");
  m = random_material<2>(k, 1);
  std::vector<double> c = std::get<SplineField<2>>(m.beta[1]).coefficients();
  c[5] = -1e-300;
  m.beta[1] = testing::make_field<2>(k, c);
  EXPECT_EQ(place(m), "beta12: coefficient (1, 1)");
  m.beta[1] = 0.0;
  m.mass = -1.0;
  EXPECT_EQ(place(m), "mass");
  // On the edge: alpha12² = alpha11 alpha22 in every coefficient.
  MaterialFieldOf<2> edge;
  edge.alpha[0] = *on_knots<2>(4.0, k);
  edge.alpha[1] = *on_knots<2>(-2.0, other);
  edge.alpha[2] = 1.0;
  EXPECT_EQ(place(edge), "");
  edge.alpha[1] = *on_knots<2>(-2.0000001, other);
  EXPECT_NE(place(edge), "");
}

}  // namespace
}  // namespace knead
