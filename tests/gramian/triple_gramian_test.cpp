#include "knead/gramian/triple_gramian.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gramian/piece_basis.hpp"
#include "gramian/span_basis.hpp"
#include "knead/gramian/gramian.hpp"
#include "support/knot_families.hpp"
#include "support/numbers.hpp"
#include "support/quad_gramian.hpp"

namespace knead {
namespace {

using testing::Quad;

using testing::largest;

TEST(TripleGramian, with_the_constant_coefficient_one_is_the_gramian) {
  for (const int p : {1, 2, 3, 5, 8}) {
    for (const auto& [name, knots] : testing::knot_families(p)) {
      for (int a = 0; a <= 2; ++a) {
        for (int b = 0; b <= a; ++b) {
          const TripleGramian triple = *triple_gramian(knots, knots, a, b);
          const std::vector<double> ones(static_cast<std::size_t>(triple.coefficient_count()), 1.0);
          const Eigen::MatrixXd expected = gramian(knots, a, b)->dense();
          const Eigen::MatrixXd size =
              gramian(knots, a, a)->dense().diagonal().cwiseSqrt() *
              gramian(knots, b, b)->dense().diagonal().cwiseSqrt().transpose();
          EXPECT_LE(largest(triple.contract(ones).dense() - expected), 1e-13 * largest(size))
              << name << a << b;
        }
      }
    }
  }
}

// Entry by entry against quadruple precision, the coefficient of another degree on other knots of
// the domain.
TEST(TripleGramian, is_exact_between_different_knot_vectors) {
  const KnotVector knots = testing::clamped_knots(3, {0, 1, 2.5, 2.75, 4}, {0, 1, 2, 1, 0});
  const KnotVector coefficient = testing::clamped_knots(2, {0, 0.75, 2.5, 3, 4}, {0, 1, 3, 1, 0});
  const testing::QuadRule rule = testing::quad_rule(5);
  std::vector<double> breaks{0, 0.75, 1, 2.5, 2.75, 3, 4};
  for (int a = 0; a <= 2; ++a) {
    const TripleGramian triple = *triple_gramian(coefficient, knots, a, 1);
    for (int k = 0; k < coefficient.count(); ++k) {
      for (int i = 0; i < knots.count(); ++i) {
        for (int j = 0; j < knots.count(); ++j) {
          Quad exact = 0, size = 0;
          for (std::size_t s = 0; s + 1 < breaks.size(); ++s) {
            const double middle = (breaks[s] + breaks[s + 1]) / 2;
            const int span = knots.find_span(middle), other = coefficient.find_span(middle);
            for (std::size_t g = 0; g < rule.t.size(); ++g) {
              const Quad h = Quad(breaks[s + 1]) - breaks[s], u = breaks[s] + h * rule.t[g];
              const Quad term = h * rule.weight[g] *
                                testing::quad_basis(coefficient, k, 2, 0, other, u) *
                                testing::quad_basis(knots, i, 3, a, span, u) *
                                testing::quad_basis(knots, j, 3, 1, span, u);
              exact += term;
              size += testing::magnitude(term);
            }
          }
          EXPECT_NEAR(triple(k, i, j), static_cast<double>(exact),
                      1e-14 * static_cast<double>(size))
              << k << " " << i << " " << j;
        }
      }
    }
  }
}

TEST(TripleGramian, is_symmetric_in_its_three_functions) {
  const KnotVector knots = testing::thesis_knots(3, 1);
  const TripleGramian triple = *triple_gramian(knots, knots, 0, 0);
  for (int k = 0; k < knots.count(); ++k) {
    for (int i = 0; i < knots.count(); ++i) {
      for (int j = 0; j < knots.count(); ++j) {
        EXPECT_NEAR(triple(k, i, j), triple(i, k, j), 1e-16);
        EXPECT_NEAR(triple(k, i, j), triple(k, j, i), 1e-16);
        EXPECT_GE(triple(k, i, j), 0);
      }
    }
  }
}

TEST(MixedGramian, of_a_knot_vector_with_itself_is_the_gramian) {
  for (const int p : {1, 3, 6}) {
    for (const auto& [name, knots] : testing::knot_families(p)) {
      const Eigen::MatrixXd expected = gramian(knots, 0, 0)->dense();
      EXPECT_LE(largest(Eigen::MatrixXd(*mixed_gramian(knots, 0, knots, 0)) - expected),
                1e-14 * largest(expected))
          << name;
    }
  }
}

TEST(MixedGramian, carries_the_partition_of_unity_of_either_side) {
  const KnotVector rows = testing::clamped_knots(4, {0, 1, 1.5, 3}, {0, 2, 1, 0});
  const KnotVector columns = testing::clamped_knots(2, {0, 0.5, 1.5, 2, 3});
  const Eigen::MatrixXd mixed(*mixed_gramian(rows, 0, columns, 0));
  for (int i = 0; i < rows.count(); ++i)
    EXPECT_NEAR(mixed.row(i).sum(), (rows[i + 5] - rows[i]) / 5, 1e-15);
  for (int j = 0; j < columns.count(); ++j)
    EXPECT_NEAR(mixed.col(j).sum(), (columns[j + 3] - columns[j]) / 3, 1e-15);
  EXPECT_LE(largest(Eigen::MatrixXd(*mixed_gramian(rows, 0, columns, 1)).rowwise().sum()), 1e-14);
  EXPECT_LE(largest(mixed.transpose() - Eigen::MatrixXd(*mixed_gramian(columns, 0, rows, 0))),
            1e-16);
}

// Inserting a knot, N = R L with R of Boehm's coefficients: the Gramian of the coarse basis is Rᵀ G
// R.
TEST(Gramian, of_the_coarse_basis_is_that_of_the_fine_one_between_its_knot_insertion) {
  for (const int p : {1, 2, 3, 5, 7}) {
    const KnotVector coarse = testing::clamped_knots(p, {0, 1, 1.25, 3, 4, 7}, {0, 1, p, 1, 1, 0});
    const double inserted = 3.5;
    const int span = coarse.find_span(inserted), n = coarse.count();
    std::vector<double> knots(coarse.knots().begin(), coarse.knots().end());
    knots.insert(knots.begin() + span + 1, inserted);
    const KnotVector fine = testing::make_knots(p, knots);
    Eigen::MatrixXd refine = Eigen::MatrixXd::Zero(n + 1, n);
    for (int i = 0; i <= n; ++i) {
      const double alpha = i <= span - p ? 1
                           : i > span    ? 0
                                         : (inserted - coarse[i]) / (coarse[i + p] - coarse[i]);
      if (i < n) refine(i, i) = alpha;
      if (i > 0) refine(i, i - 1) = 1 - alpha;
    }
    for (int a = 0; a <= 2; ++a) {
      const Eigen::MatrixXd direct = gramian(coarse, a, a)->dense(),
                            fine_gramian = gramian(fine, a, a)->dense();
      EXPECT_LE(largest(refine.transpose() * fine_gramian * refine - direct),
                1e-13 * largest(fine_gramian))
          << p << a;
    }
  }
}

/// Everything that the kernels compute of one piece, for functions of a degree and their
/// derivatives of an order.
std::vector<double> by_kernels(const detail::PieceKernels& kernels, int p, int order) {
  const KnotVector knots = testing::thesis_knots(p, 1);
  const detail::PiecePoints points(p + 2);
  const std::ptrdiff_t n = points.padded(), functions = p + 1;
  detail::PieceBasis f(knots, order, points, kernels), c(knots, 0, points, kernels);
  std::vector<double> result;
  for (const int span : knots.spans()) {
    const double lower = knots[span], upper = lower + 0.7 * (knots[span + 1] - lower);
    f.enter(span, lower, upper);
    c.enter(span, lower, upper);
    std::vector<double> weighted(static_cast<std::size_t>(functions * n)),
        products(weighted.size() * (p + 1));
    std::vector<double> sums(static_cast<std::size_t>(functions * functions * functions), 1.0);
    std::vector<double*> to;
    for (std::ptrdiff_t k = 0; k < functions * functions; ++k)
      to.push_back(sums.data() + k * functions);
    kernels.weigh(upper - lower, points.weights.data(), f.values(), functions, n, weighted.data());
    kernels.multiply(weighted.data(), f.values(), functions, false, n, products.data());
    kernels.accumulate(products.data(), functions * functions, n, points.count, c.by_points(),
                       functions, c.width(), to.data());
    result.insert(result.end(), f.values(), f.values() + functions * n);
    result.insert(result.end(), sums.begin(), sums.end());
  }
  return result;
}

TEST(PieceKernels, give_the_same_bits_on_every_instruction_set) {
  for (int p = 1; p <= 12; ++p) {
    for (int order = 0; order <= p; ++order) {
      const std::vector<double> reference =
          by_kernels(detail::piece_kernels(InstructionSet::vector128), p, order);
      for (const InstructionSet set : available_instruction_sets()) {
        EXPECT_EQ(by_kernels(detail::piece_kernels(set), p, order), reference)
            << name(set) << p << order;
      }
    }
  }
}

// Against the functions that every other Gauss method has; the degrees 2 and 3 are unrolled.
TEST(PieceBasis, has_the_functions_of_a_span) {
  const detail::PieceKernels& kernels = detail::piece_kernels();
  for (int p = 1; p <= 7; ++p) {
    const KnotVector knots = testing::thesis_knots(p, 2);
    const detail::PiecePoints points(5);
    for (int order = 0; order <= p + 1; ++order) {
      detail::PieceBasis basis(knots, order, points, kernels);
      detail::SpanValues<double> expected[1];
      for (const int span : knots.spans()) {
        basis.enter(span, knots[span], knots[span + 1]);
        for (std::ptrdiff_t g = 0; g < points.count; ++g) {
          const auto at = static_cast<std::size_t>(g);
          detail::span_basis(knots, span, points.t[at], points.complement[at], &order, 1, expected);
          const double size = std::abs(*std::ranges::max_element(
              expected[0], expected[0] + p + 1, {}, [](double value) { return std::abs(value); }));
          for (int r = 0; r <= p; ++r) {
            EXPECT_NEAR(basis.values()[r * points.padded() + g], expected[0][r], 1e-14 * size)
                << p << order << r;
          }
        }
      }
    }
  }
}

TEST(MixedGramian, refuses_domains_that_differ_and_negative_orders) {
  const KnotVector one = testing::clamped_knots(2, {0, 1}),
                   other = testing::clamped_knots(2, {0, 1.0000001});
  EXPECT_EQ(mixed_gramian(one, 0, other, 0).error().kind, ErrorKind::input);
  EXPECT_EQ(triple_gramian(one, other, 0, 0).error().kind, ErrorKind::input);
  EXPECT_EQ(mixed_gramian(one, -1, one, 0).error().kind, ErrorKind::usage);
}

}  // namespace
}  // namespace knead
