// The references that the accuracy tests lean on, checked against exact rational arithmetic.
#include <gtest/gtest.h>

#include "support/exact_gramian.hpp"
#include "support/gramian_error.hpp"
#include "support/listed_families.hpp"

namespace knead {
namespace {

using testing::Quad;

constexpr int tabulated[4][2] = {{0, 0}, {1, 0}, {1, 1}, {2, 2}};

/// A thousandth of the tightest bound that is tested with them, 1e-14; 10 as an entry by itself
/// too.
void expect_good_enough(const KnotVector& knots) {
  const int p = knots.degree();
  for (const auto& [a, b] : tabulated) {
    const testing::QuadGramian quad = testing::quad_gramian(knots, a, b);
    const std::vector<mpq_class> exact = testing::exact_gramian(knots, a, b);
    for (int i = 0; i < quad.n; ++i) {
      for (int j = std::max(0, i - p); j <= std::min(quad.n - 1, i + p); ++j) {
        const mpq_class& truth = exact[quad.at(i, j)];
        const Quad scale = b == 0 && i != j && knots.clamped()
                               ? testing::magnitude(quad.value(i, j))
                               : quad.absolute(i, j);
        if (scale == 0) {
          EXPECT_EQ(truth, 0) << a << b << ": " << i << ", " << j;
        } else if (scale > testing::smallest_compared) {
          const mpq_class error = abs(testing::rational(quad.value(i, j)) - truth);
          EXPECT_LE(error, testing::rational(scale) * mpq_class(1e-17))
              << a << b << ": " << i << ", " << j;
        }
      }
    }
  }
}

TEST(QuadReference, is_exact_enough_on_every_family_of_low_degree) {
  for (int p = 1; p <= 4; ++p) {
    for (const auto& [name, knots] : testing::knot_families(p)) {
      SCOPED_TRACE(name);
      expect_good_enough(knots);
    }
  }
}

TEST(QuadReference, is_exact_enough_on_random_members_of_every_family) {
  for (const int p : {3, 5}) {
    for (std::size_t family = 0; family < testing::listed_families.size(); ++family) {
      const unsigned seed = static_cast<unsigned>(100 * p) + static_cast<unsigned>(family);
      SCOPED_TRACE(std::string(testing::listed_families[family]) + ", p = " + std::to_string(p) +
                   ", seed " + std::to_string(seed));
      std::mt19937_64 random(seed);
      expect_good_enough(testing::random_member(random, p, family));
    }
  }
}

// Knots of few digits, as rationals grow with every degree.
TEST(QuadReference, is_exact_enough_up_to_the_highest_degree) {
  expect_good_enough(testing::clamped_knots(8, {0, 1, 10, 100}));
  expect_good_enough(testing::clamped_knots(8, {0, 1, 1 + 0x1p-40, 2}));
  expect_good_enough(testing::clamped_knots(15, {0, 1, 1.25, 3}, {0, 2, 1, 0}));
}

// ∫|N_i^(a) N_j^(b)| is taken at the p + 1 points that integrate the product without the bars; with
// them the sum is close to the integral, which many points on many pieces of each span give.
TEST(QuadReference, measures_errors_beside_the_true_absolute_integrals) {
  for (const int p : {1, 2, 3, 5, 8, 12}) {
    const KnotVector knots = testing::thesis_knots(p, 1);
    const testing::QuadRule rule = testing::quad_rule(4);
    for (const auto& [a, b] : tabulated) {
      const testing::QuadGramian quad = testing::quad_gramian(knots, a, b);
      std::vector<Quad> fine(quad.absolutes.size());
      constexpr int pieces = 25;
      for (const int s : knots.spans()) {
        const Quad h = (Quad(knots[s + 1]) - Quad(knots[s])) / pieces;
        for (int piece = 0; piece < pieces; ++piece) {
          for (std::size_t g = 0; g < rule.t.size(); ++g) {
            const Quad u = Quad(knots[s]) + h * (piece + rule.t[g]);
            const auto f = testing::quad_span_basis(knots, p, a, s, u),
                       f_b = testing::quad_span_basis(knots, p, b, s, u);
            for (int i = 0; i <= p; ++i) {
              for (int j = 0; j <= p; ++j) {
                fine[quad.at(s - p + i, s - p + j)] +=
                    testing::magnitude(h * rule.weight[g] * f[static_cast<std::size_t>(i)] *
                                       f_b[static_cast<std::size_t>(j)]);
              }
            }
          }
        }
      }
      for (std::size_t k = 0; k < fine.size(); ++k) {
        if (fine[k] == 0) continue;
        const double ratio = static_cast<double>(quad.absolutes[k] / fine[k]);
        EXPECT_GT(ratio, 0.75) << p << ", " << a << b;
        EXPECT_LT(ratio, 1.25) << p << ", " << a << b;
      }
    }
  }
}

}  // namespace
}  // namespace knead
