#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "gramian/simd/rational_kernels.hpp"
#include "knead/energy/field_assembler.hpp"
#include "knead/gramian/rational_gramian.hpp"
#include "support/fields.hpp"
#include "support/numbers.hpp"
#include "support/quad_rational.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

using testing::quad_rational;

/// Rounding, relative to the diagonal.
constexpr double rounding = 1e-12;

std::vector<double> random_weights(int count, double decades, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<double> weights(static_cast<std::size_t>(count));
  for (double& w : weights)
    w = std::pow(10, decades * (2 * static_cast<double>(random() >> 11) * 0x1p-53 - 1));
  return weights;
}

/// Stretch and bend with cross terms, and a mass.
Energy<2> energy_with_everything() {
  Energy<2> energy = stretch_and_bend(Material{{1, -0.4, 0.8}, {0.3, 0.5, 0.2}});
  for (const auto& term : mass_energy<2>(0.7)) energy.push_back(term);
  return energy;
}

/// The largest |a − b|_IJ / √(d_I d_J).
double relative_error(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                      const Eigen::VectorXd& d) {
  double worst = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      if (d[i] * d[j] > 0)
        worst = std::max(worst, std::abs(a(i, j) - b(i, j)) / std::sqrt(d[i] * d[j]));
    }
  }
  return worst;
}

using Long = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// One direction of a surface of one element: derivatives 0 to 2 of all functions at the points of
/// 48 equal parts.
struct LongTable {
  std::vector<Long> values;  ///< (function, derivative) at every point
  std::vector<long double> weights, at;
};
LongTable tabulate(const KnotVector& knots) {
  const auto rule = testing::quad_rule(12);
  LongTable table;
  const int p = knots.degree(), parts = 48, span = knots.spans().front();
  const testing::Quad h = testing::Quad(knots[span + 1]) - testing::Quad(knots[span]);
  for (int part = 0; part < parts; ++part) {
    for (std::size_t g = 0; g < rule.t.size(); ++g) {
      const testing::Quad u = testing::Quad(knots[span]) + h * (part + rule.t[g]) / parts;
      Long values(p + 1, 3);
      for (int d = 0; d < 3; ++d) {
        const auto n = testing::quad_span_basis(knots, p, d, span, u);
        for (int r = 0; r <= p; ++r)
          values(r, d) = static_cast<long double>(n[static_cast<std::size_t>(r)]);
      }
      table.values.push_back(values);
      table.weights.push_back(static_cast<long double>(h * rule.weight[g] / parts));
      table.at.push_back(static_cast<long double>(u));
    }
  }
  return table;
}

/// ∂^(k,l) R of a surface of one element at a point: (function, derivative 00, 10, 01, 20, 11, 02).
Long rational_values(const Long& u, const Long& v, const std::vector<double>& weights) {
  const Eigen::Index m = u.rows(), n = v.rows();
  const int orders[6][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};
  Long a(m * n, 6);
  for (int o = 0; o < 6; ++o) {
    for (Eigen::Index i = 0; i < m * n; ++i) {
      a(i, o) =
          weights[static_cast<std::size_t>(i)] * u(i / n, orders[o][0]) * v(i % n, orders[o][1]);
    }
  }
  const Long w = a.colwise().sum();
  Long r(m * n, 6);
  r.col(0) = a.col(0) / w(0);
  r.col(1) = (a.col(1) - w(1) * r.col(0)) / w(0);
  r.col(2) = (a.col(2) - w(2) * r.col(0)) / w(0);
  r.col(3) = (a.col(3) - 2 * w(1) * r.col(1) - w(3) * r.col(0)) / w(0);
  r.col(4) = (a.col(4) - w(1) * r.col(2) - w(2) * r.col(1) - w(4) * r.col(0)) / w(0);
  r.col(5) = (a.col(5) - 2 * w(2) * r.col(2) - w(5) * r.col(0)) / w(0);
  return r;
}

struct Reference {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd diagonal;  ///< for the absolute values of the coefficients
};
/// K of a surface of one element with coefficients factor(u, v), in extended precision.
template <class Factor>
Reference reference_of(const Surface& s, const Energy<2>& energy, const Factor& factor) {
  Long c = Long::Zero(6, 6);
  for (const auto& term : energy)
    c(multi_index_position<2>(term.a), multi_index_position<2>(term.b)) += term.coefficient;
  const Long sizes = c.cwiseAbs().rowwise().sum().asDiagonal();
  const std::vector<double> weights(s.weights().begin(), s.weights().end());
  const LongTable u = tabulate(s.knots(0)), v = tabulate(s.knots(1));
  Long k = Long::Zero(s.size(), s.size()), d = Long::Zero(s.size(), s.size());
  for (std::size_t g = 0; g < u.at.size(); ++g) {
    for (std::size_t h = 0; h < v.at.size(); ++h) {
      const Long r = rational_values(u.values[g], v.values[h], weights);
      const long double f = factor(u.at[g], v.at[h]) * u.weights[g] * v.weights[h];
      k += f * (r * c * r.transpose());
      d.diagonal() += std::abs(f) * (r.cwiseAbs2() * sizes.diagonal());
    }
  }
  return {k.cast<double>(), d.diagonal().cast<double>()};
}

Surface one_element(int p, int q, double decades, unsigned seed) {
  const KnotVector u = testing::clamped_knots(p, {-0.5, 1.25}),
                   v = testing::uniform_unclamped(q, 1);
  const int n = u.count() * v.count();
  return testing::make_surface(u, v, testing::random_points(n, seed),
                               random_weights(n, decades, seed));
}

TEST(RationalStiffness, KeepsItsToleranceOfEveryEntryWhateverTheWeights) {
  const Energy<2> energy = energy_with_everything();
  for (const auto& [p, q, decades] :
       {std::tuple{1, 2, 0.3}, {2, 2, 1.0}, {2, 1, 1.5}, {3, 2, 0.6}}) {
    SCOPED_TRACE(::testing::Message() << p << q << " 10^±" << decades);
    const Surface s = one_element(p, q, decades, static_cast<unsigned>(10 * p + q));
    const Reference exact = reference_of(s, energy, [](long double, long double) { return 1.0L; });
    for (const double tolerance : {1e-3, 1e-7, 1e-10, 1e-13}) {
      const auto k = Stiffness<2>::create(s, energy, {.rational_tolerance = tolerance});
      ASSERT_TRUE(k) << k.error().message();
      EXPECT_LE(k->error_bound(), tolerance);
      EXPECT_LE(relative_error(Eigen::MatrixXd(k->assemble()), exact.matrix, exact.diagonal),
                k->error_bound() + rounding);
    }
  }
}

// What fixed points do to such a patch: p + 8 of them err by more than a thousandth of the energy
// with weights from 0.1 to 10, and give numbers without meaning from 0.01 to 100.
TEST(RationalStiffness, IsExactWhereAFixedNumberOfPointsIsNot) {
  for (const auto& [decades, fixed] : {std::pair{1.0, 1e-3}, {2.0, 0.3}}) {
    const KnotVector k = testing::clamped_knots(2, {0, 1});
    const Surface s =
        testing::make_surface(k, k, testing::random_points(9, 3), random_weights(9, decades, 5));
    Material bend;
    bend.alpha = {0, 0, 0};
    bend.beta = {1, 1, 1};
    const double fine =
        Stiffness<2>::create(s, stretch_and_bend(bend), {.rational_tolerance = 1e-14})
            ->energy(s.control_points());
    const double made = Stiffness<2>::create(s, stretch_and_bend(bend))->energy(s.control_points());
    const double by_points =
        Stiffness<2>::create(s, stretch_and_bend(bend), {.rational_gauss_points = 10})
            ->energy(s.control_points());
    EXPECT_NEAR(made, fine, 1e-9 * fine);
    EXPECT_GT(std::abs(by_points - fine), fixed * fine);
  }
}

/// Of weights that are products the matrices are Kronecker products of those of curves.
Eigen::MatrixXd kronecker(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd result(a.rows() * b.rows(), a.cols() * b.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j)
      result.block(i * b.rows(), j * b.cols(), b.rows(), b.cols()) = a(i, j) * b;
  }
  return result;
}
std::vector<double> products(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> result;
  for (const double x : a) {
    for (const double y : b) result.push_back(x * y);
  }
  return result;
}

TEST(RationalStiffness, KeepsItsToleranceOnNetsOfManyElementsAndWeightsFromAThousandthToAThousand) {
  const Energy<2> energy = stretch_and_bend(Material{{1, 0, 0.5}, {0.2, 0.4, 0.1}});
  const std::pair<KnotVector, KnotVector> nets[] = {
      {testing::clamped_knots(2, {0, 1, 2, 5}, {0, 2, 1, 0}), testing::uniform_unclamped(3, 3)},
      {testing::clamped_knots(3, {0, 1e-3, 1}), testing::clamped_knots(1, {2, 3, 7})},
  };
  for (const auto& [u, v] : nets) {
    const auto wu = random_weights(u.count(), 3, 1), wv = random_weights(v.count(), 2, 2);
    const Surface s = testing::make_surface(u, v, testing::random_points(u.count() * v.count(), 4),
                                            products(wu, wv));
    Eigen::MatrixXd exact = Eigen::MatrixXd::Zero(s.size(), s.size());
    for (const auto& t : energy) {
      exact += t.coefficient * kronecker(quad_rational(u, wu, t.a[0], t.b[0]),
                                         quad_rational(v, wv, t.a[1], t.b[1]));
    }
    const auto k = Stiffness<2>::create(s, energy);
    ASSERT_TRUE(k) << k.error().message();
    EXPECT_LE(k->error_bound(), default_rational_tolerance);
    EXPECT_LE(relative_error(Eigen::MatrixXd(k->assemble()), exact, exact.diagonal()),
              k->error_bound() + rounding);
  }
}

TEST(RationalStiffness, OfCurvesAndVolumesKeepsItsToleranceToo) {
  const KnotVector t = testing::clamped_knots(3, {0, 0.5, 0.6, 2}, {0, 3, 1, 0});
  const auto w = random_weights(t.count(), 3, 8);
  const Curve curve = *Curve::create({t}, testing::random_points(t.count(), 1), w);
  const auto k = Stiffness<1>::create(curve, {{1, {1}, {1}}, {0.01, {2}, {2}}});
  ASSERT_TRUE(k) << k.error().message();
  const Eigen::MatrixXd exact = quad_rational(t, w, 1, 1) + 0.01 * quad_rational(t, w, 2, 2);
  EXPECT_LE(relative_error(Eigen::MatrixXd(k->assemble()), exact, exact.diagonal()),
            1e-10 + rounding);

  const KnotVector a = testing::clamped_knots(2, {0, 1}), b = testing::clamped_knots(1, {0, 2, 3}),
                   c = testing::clamped_knots(2, {0, 1, 3});
  const auto wa = random_weights(3, 0.5, 1), wb = random_weights(3, 0.3, 2),
             wc = random_weights(4, 0.4, 3);
  const Volume volume =
      *Volume::create({a, b, c}, testing::random_points(36, 2), products(products(wa, wb), wc));
  const Energy<3> energy = {
      {1, {1, 0, 0}, {1, 0, 0}}, {0.5, {0, 1, 1}, {0, 1, 1}}, {0.1, {0, 0, 2}, {0, 0, 2}}};
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(36, 36);
  for (const auto& term : energy) {
    expected += term.coefficient * kronecker(kronecker(quad_rational(a, wa, term.a[0], term.b[0]),
                                                       quad_rational(b, wb, term.a[1], term.b[1])),
                                             quad_rational(c, wc, term.a[2], term.b[2]));
  }
  const auto of_volume = Stiffness<3>::create(volume, energy);
  ASSERT_TRUE(of_volume) << of_volume.error().message();
  EXPECT_LE(of_volume->error_bound(), default_rational_tolerance);
  EXPECT_LE(relative_error(Eigen::MatrixXd(of_volume->assemble()), expected, expected.diagonal()),
            1e-10 + rounding);
}

TEST(RationalStiffness, WithACoefficientThatVariesKeepsItsTolerance) {
  const Surface s = one_element(2, 2, 0.7, 6);
  const KnotVector fu = testing::clamped_knots(2, {-0.5, 0.1, 1.25}), &v = s.knots(1);
  const auto [lower, upper] = v.domain();
  const KnotVector fv = testing::clamped_knots(1, {lower, upper});
  const auto field = testing::make_field<2>({fu, fv}, {1, 0.2, 3, 1, 0.5, 2, 0, 1});
  FieldEnergy<2> energy;
  for (const auto& term : stretch_and_bend(Material{{0, 0, 0}, {1, 0.5, 2}}))
    energy.push_back({term.coefficient, field, term.a, term.b});
  const Reference exact = reference_of(
      s, stretch_and_bend(Material{{0, 0, 0}, {1, 0.5, 2}}), [&](long double x, long double y) {
        return static_cast<long double>(
            *field.at({static_cast<double>(x), static_cast<double>(y)}));
      });
  // The reference's parts do not end at the field's knot, across which its slope jumps.
  FieldAssembler<2> assembler(s);
  const auto made = assembler.assemble(energy);
  ASSERT_TRUE(made) << made.error().message();
  EXPECT_LE(relative_error(Eigen::MatrixXd(*made), exact.matrix, exact.diagonal), 1e-6);
  // A polynomial field is the same, piece by piece; here the parts of the reference are exact.
  const auto smooth =
      testing::make_field<2>({testing::clamped_knots(2, {-0.5, 1.25}), fv}, {1, 0.2, 3, 1, 0.5, 2});
  for (auto& term : energy) term.coefficient = smooth;
  const Reference exact_smooth = reference_of(
      s, stretch_and_bend(Material{{0, 0, 0}, {1, 0.5, 2}}), [&](long double x, long double y) {
        return static_cast<long double>(
            *smooth.at({static_cast<double>(x), static_cast<double>(y)}));
      });
  const auto of_smooth = assembler.assemble(energy);
  ASSERT_TRUE(of_smooth);
  EXPECT_LE(relative_error(Eigen::MatrixXd(*of_smooth), exact_smooth.matrix, exact_smooth.diagonal),
            1e-10 + rounding);
}

TEST(RationalStiffness, KeepsItsToleranceWithWeightsFromAMillionthToAMillion) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    const int spans = 1 + static_cast<int>(seed % 3), p = 1 + static_cast<int>(seed % 2);
    const KnotVector k = testing::uniform_clamped(p, spans);
    const int n = k.count() * k.count();
    const Surface s =
        testing::make_surface(k, k, testing::random_points(n, seed), random_weights(n, 6, seed));
    const auto made = Stiffness<2>::create(s, stretch_and_bend({}));
    ASSERT_TRUE(made) << made.error().message();
    EXPECT_LE(made->error_bound(), default_rational_tolerance);
    // Against a tolerance that asks for other points and pieces.
    const auto finer = Stiffness<2>::create(s, stretch_and_bend({}), {.rational_tolerance = 1e-13});
    ASSERT_TRUE(finer) << finer.error().message();
    const Eigen::MatrixXd a(made->assemble()), b(finer->assemble());
    EXPECT_LE(relative_error(a, b, b.diagonal()), default_rational_tolerance + rounding);
  }
}

TEST(RationalStiffness, RefusesWeightsBeyondItsLimitWithTheReason) {
  const KnotVector k = testing::uniform_clamped(2, 2);
  std::vector<double> weights(16, 1e-30);
  weights[5] = 1e30;
  const auto made = Stiffness<2>::create(
      testing::make_surface(k, k, testing::random_points(16, 1), weights), stretch_and_bend({}));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().kind, ErrorKind::numerical);
  EXPECT_NE(made.error().what.find("1e-30 to 1e+30, differ so much"), std::string::npos)
      << made.error().what;
  EXPECT_NE(made.error().remedy.find("larger tolerance"), std::string::npos);
}

TEST(RationalStiffness, RefusesOptionsThatMeanNothing) {
  const Surface s = testing::cylinder();
  const auto with = [&](const StiffnessOptions& options) {
    return Stiffness<2>::create(s, stretch_and_bend({}), options);
  };
  for (const double tolerance : {0.0, -1.0, testing::nan}) {
    EXPECT_EQ(with({.rational_tolerance = tolerance}).error().kind, ErrorKind::usage) << tolerance;
  }
  EXPECT_EQ(with({.rational_gauss_points = 65}).error().kind, ErrorKind::usage);
  EXPECT_EQ(with({.rational_gauss_points = -1}).error().kind, ErrorKind::usage);
  const Energy<2> third = {{1, {2, 1}, {2, 1}}};
  EXPECT_EQ(Stiffness<2>::create(s, third).error().kind, ErrorKind::usage);
}

TEST(RationalStiffness, WithAConstantDenominatorIsTheThesisApproximation) {
  const double w = std::sqrt(0.5);
  const KnotVector circle = testing::clamped_knots(2, {0, 1, 2, 3, 4}, {0, 2, 2, 2, 0}),
                   line = testing::clamped_knots(1, {0, 1});
  const std::vector<double> weights{1, w, 1, w, 1, w, 1, w, 1};
  const Surface s =
      testing::make_surface(circle, line, testing::random_points(18, 1), products(weights, {1, 1}));
  const double expected[3] = {0.18, 0.48, 0.52};  // of the largest entry, as on the circle
  for (int order = 0; order < 3; ++order) {
    const Energy<2> energy = {{1, {order, 0}, {order, 0}}};
    const auto made =
        Stiffness<2>::create(s, energy, {.denominator = RationalDenominator::constant});
    ASSERT_TRUE(made);
    EXPECT_EQ(made->error_bound(), std::numeric_limits<double>::infinity());
    const Eigen::MatrixXd a(made->assemble()), b(Stiffness<2>::create(s, energy)->assemble()),
        curve = kronecker(constant_denominator_gramian(circle, weights, order, order)->dense(),
                          quad_rational(line, {1, 1}, 0, 0));
    EXPECT_LE(testing::largest(a - curve), 1e-14 * testing::largest(curve));
    EXPECT_NEAR(testing::largest(a - b) / testing::largest(b), expected[order], 0.01) << order;
  }
}

TEST(RationalKernels, GiveTheSameBitsByEveryInstructionSet) {
  constexpr std::ptrdiff_t n = 12, stride = 28, rows = 24, width = 3;
  const auto& reference = detail::rational_kernels(InstructionSet::vector128);
  for (const std::ptrdiff_t functions : {3, 6, 9, 15, 16}) {
    const Eigen::VectorXd x = Eigen::VectorXd::Random(functions * stride),
                          y = Eigen::VectorXd::Random(functions * stride),
                          f = Eigen::VectorXd::Random(functions + n);
    for (const InstructionSet set : available_instruction_sets()) {
      const auto& kernels = detail::rational_kernels(set);
      Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(functions, functions), block = expected;
      reference.lower_products(x.data(), y.data(), stride, rows, functions, expected.data());
      kernels.lower_products(x.data(), y.data(), stride, rows, functions, block.data());
      EXPECT_EQ(block, expected) << name(set) << functions;
      const Eigen::Map<const Eigen::MatrixXd> a(x.data(), stride, functions),
          b(y.data(), stride, functions);
      const Eigen::MatrixXd product = a.topRows(rows).transpose() * b.topRows(rows);
      EXPECT_LE(testing::largest(Eigen::MatrixXd((block - product).triangularView<Eigen::Lower>())),
                1e-14 * rows);
      Eigen::VectorXd to = x, wanted = x, sum = Eigen::VectorXd::Zero(n), wanted_sum = sum;
      if (functions % width == 0) {
        reference.numerators(y.data(), f.data(), width, functions, n, wanted.data(),
                             wanted_sum.data());
        kernels.numerators(y.data(), f.data(), width, functions, n, to.data(), sum.data());
        EXPECT_EQ(to, wanted);
        EXPECT_EQ(sum, wanted_sum);
      }
      reference.subtract(f.data(), y.data(), functions, n, wanted.data());
      kernels.subtract(f.data(), y.data(), functions, n, to.data());
      EXPECT_EQ(to, wanted);
      reference.scale(f.data(), y.data(), functions, n, stride, wanted.data());
      kernels.scale(f.data(), y.data(), functions, n, stride, to.data());
      EXPECT_EQ(to, wanted);
    }
  }
}

}  // namespace
}  // namespace knead
