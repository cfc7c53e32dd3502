// Gramians of every order a, b, and who computes them.
#include <gtest/gtest.h>

#include "gramian/operation_count.hpp"
#include "knead/gramian/gramian.hpp"
#include "support/gramian_error.hpp"
#include "support/knot_families.hpp"
#include "support/listed_families.hpp"
#include "support/long_run.hpp"

namespace knead {
namespace {

using testing::worst_error;

class OrdersOfDegree : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, OrdersOfDegree, ::testing::Range(1, 11));

// On clusters a derivative may change its sign among knots 1e-13 apart, where no double method
// knows its value: there orders above 2 are right beside the integral of the sums of the magnitudes
// of its terms.
TEST_P(OrdersOfDegree, are_right_by_gauss_and_gauss_reduced_on_every_family) {
  const int p = GetParam();
  const double bound = p <= 7 ? 1e-14 : 3e-14;
  auto families = testing::knot_families(p);
  for (std::size_t family = 0; family < (p <= 7 ? testing::listed_families.size() : 0); ++family) {
    const unsigned seed = static_cast<unsigned>(1000 * p) + static_cast<unsigned>(family);
    std::mt19937_64 random(seed);
    families.push_back(
        {std::string(testing::listed_families[family]) + " seed " + std::to_string(seed),
         testing::random_member(random, p, family)});
  }
  // No number of pairs of orders has a factor in common with five: every knot vector has its turn,
  // and every pair.
  testing::Sample sample(p <= 7 ? 1 : 5);
  for (const auto& [name, knots] : families) {
    const bool cluster = name.find("cluster") != name.npos;
    for (int a = 0; a <= p; ++a) {
      for (int b = a <= 2 ? 0 : a; b <= p; ++b) {
        if (!sample.next()) continue;
        const bool by_terms = cluster && std::max(a, b) > 2;
        const testing::QuadGramian exact = testing::quad_gramian(
            knots, a, b, by_terms ? testing::Terms::magnitudes : testing::Terms::values);
        EXPECT_LE(worst_error(*gramian(knots, a, b, GramianMethod::gauss), exact), bound)
            << name << " " << a << b;
        EXPECT_LE(worst_error(*gramian(knots, a, b, GramianMethod::gauss_reduced), exact), bound)
            << name << a << b;
      }
    }
  }
}

TEST_P(OrdersOfDegree, transpose_when_they_are_exchanged) {
  const int p = GetParam();
  for (const auto& [name, knots] : testing::knot_families(p)) {
    for (const GramianMethod method :
         {GramianMethod::gauss, GramianMethod::gauss_reduced, GramianMethod::recurrence}) {
      for (int a = 0; a <= p; ++a) {
        for (int b = 0; b < a; ++b) {
          const Eigen::MatrixXd ab = gramian(knots, a, b, method)->dense(),
                                ba = gramian(knots, b, a, method)->dense();
          // Beside what Cauchy and Schwarz allow: an entry that cancels may be small beside it.
          const Eigen::MatrixXd size =
              gramian(knots, a, a, method)->dense().diagonal().cwiseSqrt() *
              gramian(knots, b, b, method)->dense().diagonal().cwiseSqrt().transpose();
          EXPECT_LE(((ab - ba.transpose()).cwiseAbs() - 1e-14 * size).maxCoeff(), 1e-290)
              << name << a << b;
        }
      }
    }
  }
}

TEST_P(OrdersOfDegree, other_than_the_five_are_left_to_gauss_by_the_recurrence) {
  const int p = GetParam();
  const KnotVector knots = testing::thesis_knots(p, 3);
  for (int a = 0; a <= max_degree; ++a) {
    for (int b = 0; b <= max_degree; ++b) {
      const bool known = (a == b && a <= 2) || a + b == 1;
      const GramianMethod used = used_gramian_method(knots, a, b, GramianMethod::recurrence);
      EXPECT_EQ(used, known ? GramianMethod::recurrence : GramianMethod::gauss) << a << b;
      EXPECT_EQ(gramian(knots, a, b, GramianMethod::recurrence)->dense(),
                gramian(knots, a, b, used)->dense());
      for (const GramianMethod method :
           {GramianMethod::gauss, GramianMethod::gauss_reduced, GramianMethod::analytic}) {
        EXPECT_EQ(used_gramian_method(knots, a, b, method), method);
        if (a <= p && b <= p) continue;
        EXPECT_EQ(gramian(knots, a, b, method)->dense().cwiseAbs().maxCoeff(), 0) << a << b;
      }
    }
  }
}

TEST(GramianOrders, are_left_to_gauss_on_knots_out_of_the_range_of_the_recurrence) {
  const KnotVector tiny = testing::clamped_knots(3, {0, 1e-80, 2e-80});
  EXPECT_EQ(used_gramian_method(tiny, 0, 0, GramianMethod::recurrence), GramianMethod::gauss);
  EXPECT_EQ(gramian(tiny, 0, 0)->dense(), gramian(tiny, 0, 0, GramianMethod::gauss)->dense());
}

// ∫ N_i^(p) N_j^(p) is a sum over spans of products of constants: one point, and exact for small
// integers.
TEST(GramianOrders, of_the_degree_itself_are_those_of_step_functions) {
  // N_0'' = 2 on [0, 1]; N_1'' = −8/3 and 1/3.
  const KnotVector knots = testing::clamped_knots(2, {0, 1, 3});
  const auto g22 = gramian(knots, 2, 2, GramianMethod::gauss_reduced);
  EXPECT_DOUBLE_EQ((*g22)(0, 0), 4);
  EXPECT_DOUBLE_EQ((*g22)(0, 1), 2 * -8.0 / 3);
  EXPECT_DOUBLE_EQ((*g22)(1, 1), 64.0 / 9 + 2.0 / 9);
}

// Above the degrees of the kernels every point costs p(p + 1)/2 divisions for values and up to q
// more for a difference of degree q, so divisions tell the number of points: p + 1 for 00, p for 11
// and 10, p − 1 for 22.
TEST(GramianOrders, take_no_more_points_by_gauss_reduced_than_their_degree_needs) {
  for (int p = 8; p <= max_degree; ++p) {
    const auto divisions = [&](int spans) {
      return count_operations(testing::uniform_clamped(p, spans), GramianMethod::gauss_reduced)
          .divisions;
    };
    const int value = p * (p + 1) / 2, first = value + p, second = value + p + p - 1;
    const int expected = (p + 1) * value + p * first + (p - 1) * second + p * first;
    EXPECT_EQ(divisions(30) - divisions(20), 10 * expected) << p;
  }
}

}  // namespace
}  // namespace knead
