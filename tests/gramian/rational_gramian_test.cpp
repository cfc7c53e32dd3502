#include "knead/gramian/rational_gramian.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "knead/gramian/gramian.hpp"
#include "support/knot_families.hpp"
#include "support/numbers.hpp"
#include "support/quad_rational.hpp"

namespace knead {
namespace {

/// The circle (or, scaled, the ellipse) of four quadratic arcs: weights 1 and cos 45°.
const KnotVector& circle_knots() {
  static const KnotVector knots = testing::clamped_knots(2, {0, 1, 2, 3, 4}, {0, 2, 2, 2, 0});
  return knots;
}
std::vector<double> circle_weights() {
  const double w = std::sqrt(0.5);
  return {1, w, 1, w, 1, w, 1, w, 1};
}
/// The half circle that turns into a sphere.
const KnotVector& half_circle_knots() {
  static const KnotVector knots = testing::clamped_knots(2, {0, 1, 2}, {0, 2, 0});
  return knots;
}
std::vector<double> half_circle_weights() {
  const double w = std::sqrt(0.5);
  return {1, w, 1, w, 1};
}

using testing::largest;
using testing::quad_rational;

/// What rounding may add to the bound: to each entry 1e-13 of the size of its functions.
double rounding(const Eigen::MatrixXd& aa, const Eigen::MatrixXd& bb) {
  return 1e-13 * std::sqrt(largest(aa) * largest(bb));
}

void expect_within_bound(const KnotVector& knots, const std::vector<double>& weights,
                         double tolerance) {
  Eigen::MatrixXd exact[3];
  for (int a = 0; a <= 2; ++a) exact[a] = quad_rational(knots, weights, a, a);
  for (int a = 0; a <= 2; ++a) {
    for (int b = 0; b <= a; ++b) {
      const auto result = rational_gramian(knots, weights, a, b, tolerance);
      ASSERT_TRUE(result.has_value()) << result.error().message();
      const Eigen::MatrixXd reference = a == b ? exact[a] : quad_rational(knots, weights, a, b);
      const double size =
          (exact[a].diagonal().cwiseProduct(exact[b].diagonal())).cwiseSqrt().maxCoeff();
      EXPECT_LE(largest(result->matrix.dense() - reference),
                result->error_bound + rounding(exact[a], exact[b]))
          << a << b;
      EXPECT_LE(result->error_bound, 1.01 * tolerance * size) << a << b;
    }
  }
}

TEST(RationalGramian, of_a_circle_keeps_every_tolerance) {
  for (const double tolerance : {1e-3, 1e-6, 1e-10, 1e-13}) {
    expect_within_bound(circle_knots(), circle_weights(), tolerance);
  }
}

TEST(RationalGramian, of_a_circle_needs_few_points) {
  const auto coarse = rational_gramian(circle_knots(), circle_weights(), 0, 0, 1e-6);
  const auto fine = rational_gramian(circle_knots(), circle_weights(), 0, 0, 1e-13);
  EXPECT_EQ(coarse->pieces, 4);
  EXPECT_LE(coarse->largest_points, 10);
  EXPECT_LE(fine->largest_points, 17);
}

TEST(RationalGramian, with_equal_weights_is_the_polynomial_one) {
  for (const int p : {1, 2, 3, 5}) {
    for (const auto& family : testing::knot_families(p)) {
      if (!family.ordinary()) continue;
      const std::vector<double> weights(static_cast<std::size_t>(family.knots.count()), 3.0);
      for (int a = 0; a <= 2; ++a) {
        const auto result = rational_gramian(family.knots, weights, a, a, 1e-12);
        ASSERT_TRUE(result.has_value());
        const Eigen::MatrixXd expected = gramian(family.knots, a, a)->dense();
        EXPECT_LE(largest(result->matrix.dense() - expected),
                  result->error_bound + 1e-12 * largest(expected))
            << family.name << a;
      }
    }
  }
}

TEST(RationalGramian, keeps_its_bound_for_weights_from_1e_minus_3_to_1e3) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const auto uniform = [&](double a, double b) {
      return std::uniform_real_distribution<double>(a, b)(random);
    };
    const int p = 1 + static_cast<int>(seed % 5);
    std::vector<double> lengths(static_cast<std::size_t>(1 + seed % 4));
    for (double& length : lengths) length = uniform(0.3, 2);
    const KnotVector knots = testing::clamped_knots(p, testing::breaks_of(lengths));
    std::vector<double> weights(static_cast<std::size_t>(knots.count()));
    for (double& weight : weights) weight = std::pow(10, uniform(-3, 3));
    expect_within_bound(knots, weights, std::pow(10, uniform(-11, -2)));
  }
}

TEST(RationalGramian, halves_spans_where_the_denominator_varies_much) {
  const KnotVector knots = testing::clamped_knots(3, {0, 1});
  EXPECT_GT(rational_gramian(knots, std::vector<double>{1e-3, 1e3, 1e-3, 1e3}, 0, 0, 1e-10)->pieces,
            1);
}

TEST(ClosedFormGramian, of_a_circle_has_logarithms_and_arctangents_and_no_span_that_is_integrated) {
  for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}}) {
    const auto made = closed_form_rational_gramian(circle_knots(), circle_weights(), a, b, 1e-10);
    ASSERT_TRUE(made) << made.error().message();
    EXPECT_EQ(made->closed, 4) << a << b;
    EXPECT_EQ(made->integrated, 0);
    const Eigen::MatrixXd exact = quad_rational(circle_knots(), circle_weights(), a, b);
    EXPECT_LE(largest(made->matrix.dense() - exact), 1e-14 * largest(exact)) << a << b;
  }
}

TEST(ClosedFormGramian, is_left_where_it_cancels) {
  int closed = 0, integrated = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const int p = 1 + static_cast<int>(seed % 5);
    std::vector<double> lengths(static_cast<std::size_t>(1 + seed % 3));
    for (double& length : lengths) length = 0.3 + uniform();
    const KnotVector knots = testing::clamped_knots(p, testing::breaks_of(lengths));
    std::vector<double> weights(static_cast<std::size_t>(knots.count()));
    // From nearly equal ones, whose roots are far away, to factors of a thousand.
    const double decades = std::pow(10, -6 + 6.5 * static_cast<double>(seed) / 23);
    for (double& weight : weights) weight = std::pow(10, decades * (2 * uniform() - 1));
    const int order = seed % 4 == 3 ? 2 : 0;
    const auto made = closed_form_rational_gramian(knots, weights, order, order, 1e-10);
    ASSERT_TRUE(made) << made.error().message();
    closed += made->closed;
    integrated += made->integrated;
    const Eigen::MatrixXd exact = quad_rational(knots, weights, order, order);
    EXPECT_LE(largest(made->matrix.dense() - exact), 1e-10 * largest(exact));
  }
  EXPECT_GT(closed, 10);
  EXPECT_GT(integrated, 10);
}

TEST(ClosedFormGramian, with_equal_weights_is_the_polynomial_one) {
  const KnotVector knots = testing::clamped_knots(3, {0, 1, 1.5, 4}, {0, 1, 2, 0});
  const std::vector<double> weights(static_cast<std::size_t>(knots.count()), 0.7);
  const auto made = closed_form_rational_gramian(knots, weights, 1, 1, 1e-12);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->closed, 3);
  EXPECT_LE(largest(made->matrix.dense() - gramian(knots, 1, 1)->dense()),
            1e-13 * largest(made->matrix.dense()));
}

/// Surfaces of revolution: their weights are products, so their functions are products and their
/// Gramians Kronecker products of those of the curves.
void expect_product(const std::array<KnotVector, 2>& knots, const std::vector<double>& wu,
                    const std::vector<double>& wv) {
  std::vector<double> weights;
  for (const double u : wu) {
    for (const double v : wv) weights.push_back(u * v);
  }
  using Orders = std::array<int, 2>;
  const std::pair<Orders, Orders> pairs[] = {{{0, 0}, {0, 0}}, {{1, 0}, {1, 0}}, {{1, 0}, {0, 1}},
                                             {{2, 0}, {2, 0}}, {{1, 1}, {1, 1}}, {{0, 2}, {0, 1}}};
  for (const auto& [a, b] : pairs) {
    const auto result = rational_gramian(knots, weights, a, b, 1e-8);
    ASSERT_TRUE(result.has_value()) << result.error().message();
    const Eigen::MatrixXd u = quad_rational(knots[0], wu, a[0], b[0]),
                          v = quad_rational(knots[1], wv, a[1], b[1]);
    double worst = 0, size = 0;
    const Eigen::MatrixXd matrix(result->matrix);
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
        const double exact = u(i / v.rows(), j / v.cols()) * v(i % v.rows(), j % v.cols());
        worst = std::max(worst, std::abs(matrix(i, j) - exact));
        size = std::max(size, std::abs(exact));
      }
    }
    EXPECT_LE(worst, result->error_bound + 1e-13 * size) << a[0] << a[1] << b[0] << b[1];
    EXPECT_LE(result->error_bound, 1e-6 * size);
  }
}

TEST(RationalGramian, of_cylinder_sphere_and_torus_are_products_of_circles) {
  const KnotVector line = testing::clamped_knots(1, {0, 1});
  expect_product({circle_knots(), line}, circle_weights(), {1, 1});
  expect_product({circle_knots(), half_circle_knots()}, circle_weights(), half_circle_weights());
  expect_product({circle_knots(), circle_knots()}, circle_weights(), circle_weights());
}

TEST(RationalGramian, of_a_surface_sums_to_its_parameter_area_whatever_the_weights) {
  std::mt19937_64 random(7);
  for (int k = 0; k < 3; ++k) {
    const std::array<KnotVector, 2> knots{testing::clamped_knots(2, {0, 1, 3}),
                                          testing::clamped_knots(3, {0, 2})};
    std::vector<double> weights(static_cast<std::size_t>(knots[0].count() * knots[1].count()));
    for (double& weight : weights)
      weight = std::pow(10, std::uniform_real_distribution<double>(-1, 1)(random));
    const auto mass = rational_gramian(knots, weights, {0, 0}, {0, 0}, 1e-9);
    ASSERT_TRUE(mass.has_value());
    const double count = static_cast<double>(mass->matrix.rows());
    EXPECT_NEAR(mass->matrix.sum(), 6, count * count * mass->error_bound + 1e-12);
    const auto stretch = rational_gramian(knots, weights, {1, 0}, {1, 0}, 1e-9);
    ASSERT_TRUE(stretch.has_value());
    const Eigen::VectorXd rows = stretch->matrix * Eigen::VectorXd::Ones(stretch->matrix.cols());
    EXPECT_LE(rows.cwiseAbs().maxCoeff(), count * stretch->error_bound + 1e-11);
  }
}

TEST(ConstantDenominatorGramian, errs_by_a_fifth_to_a_half_on_a_circle) {
  const std::array<double, 3> errors = {0.18, 0.48, 0.52};  // of the largest entry, by order
  for (int a = 0; a < 3; ++a) {
    const Eigen::MatrixXd exact = quad_rational(circle_knots(), circle_weights(), a, a);
    const Eigen::MatrixXd approximate =
        constant_denominator_gramian(circle_knots(), circle_weights(), a, a)->dense();
    EXPECT_NEAR(largest(approximate - exact) / largest(exact), errors[static_cast<std::size_t>(a)],
                0.01)
        << a;
  }
}

TEST(ConstantDenominatorGramian, is_exact_where_the_denominator_is_constant) {
  const KnotVector knots = testing::thesis_knots(3, 2);
  const std::vector<double> weights(static_cast<std::size_t>(knots.count()), 0.25);
  const Eigen::MatrixXd expected = gramian(knots, 1, 1)->dense();
  EXPECT_LE(largest(constant_denominator_gramian(knots, weights, 1, 1)->dense() - expected),
            1e-13 * largest(expected));
}

TEST(RationalGramian, refuses_what_it_cannot_mean) {
  const KnotVector knots = testing::clamped_knots(1, {0, 1});
  const std::vector<double> good{1, 2};
  EXPECT_EQ(rational_gramian(knots, good, 3, 0, 1e-6).error().kind, ErrorKind::usage);
  EXPECT_EQ(rational_gramian(knots, good, 0, 0, 0).error().kind, ErrorKind::usage);
  EXPECT_EQ(rational_gramian(knots, good, 0, 0, NAN).error().kind, ErrorKind::usage);
  EXPECT_EQ(rational_gramian(knots, std::vector<double>{1}, 0, 0, 1e-6).error().kind,
            ErrorKind::input);
  for (const double bad : {0.0, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    const auto refused = rational_gramian(knots, std::vector<double>{1, bad}, 0, 0, 1e-6);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().where, "weight 1");
  }
}

}  // namespace
}  // namespace knead
