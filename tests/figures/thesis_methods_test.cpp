// The thesis' algorithms are run to be counted; here, that what is counted does the work.
#include "figures/thesis_methods.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "figures/tables.hpp"
#include "figures/thesis_knots.hpp"
#include "support/knot_families.hpp"

namespace knead::figures {
namespace {

constexpr ThesisMethod both[] = {ThesisMethod::gaussian, ThesisMethod::analytic};

/// The largest error beside the largest entry of each term.
double worst(const KnotVector& knots, ThesisMethod method, Reuse reuse) {
  const int p = knots.degree();
  const ThesisGramians result = thesis_gramians(knots, method, reuse);
  const GramianSet right = *gramians(knots);
  const BandMatrix* terms[] = {&right.g00, &right.g11, &right.g22, &right.g10};
  double error = 0;
  for (std::size_t t = 0; t < 4; ++t) {
    double size = 0, difference = 0;
    for (int i = 0; i < knots.count(); ++i) {
      for (int s = 0; s <= p && i + s < knots.count(); ++s) {
        size = std::max(size, std::abs((*terms[t])(i, i + s)));
        difference = std::max(difference,
                              std::abs(result.upper[t][static_cast<std::size_t>(i * (p + 1) + s)] -
                                       (*terms[t])(i, i + s)));
      }
    }
    error = std::max(error, size > 0 ? difference / size : difference);
  }
  return error;
}

TEST(ThesisMethods, give_the_gramians) {
  for (int p = 1; p <= 6; ++p) {
    for (const KnotVector& knots : {testing::uniform_clamped(p, 1), testing::uniform_clamped(p, 2),
                                    testing::uniform_clamped(p, 12),
                                    testing::clamped_knots(p, {0, 1, 1.5, 3, 3.25, 4, 6, 7})}) {
      for (const Reuse reuse : {Reuse::all_in_one, Reuse::none}) {
        EXPECT_LE(worst(knots, ThesisMethod::gaussian, reuse), 1e-13) << p;
        // The analytic method loses digits with the degree, as what it adds up grows: Σ|t|/|Σt| is
        // 400 at p = 10 already on uniform knots in the middle, and grows with the distance that a
        // function is integrated over.
        EXPECT_LE(worst(knots, ThesisMethod::analytic, reuse), 1e-15 * std::pow(12, p))
            << p << " " << knots.count();
      }
    }
  }
}

TEST(ThesisMethods, take_the_samples_and_evaluations_of_the_thesis_formulas_on_n_minus_p_spans) {
  for (int p = 1; p <= 10; ++p) {
    for (const ThesisMethod method : both) {
      for (const Reuse reuse : {Reuse::all_in_one, Reuse::none}) {
        // From 50 to 150 functions: 100 spans more. N″ of degree 1 is not evaluated.
        const Work more = thesis_gramians(testing::uniform_clamped(p, 150), method, reuse).work -
                          thesis_gramians(testing::uniform_clamped(p, 50), method, reuse).work;
        EXPECT_EQ(more.spans, 100);
        EXPECT_EQ(static_cast<double>(more.samples), 100 * expected::samples_per_span(p, method));
        const double formula = expected::evaluations(p, 99, method, reuse);  // for n + 1 = 100
        const bool no_bend = p == 1 && reuse == Reuse::none && method == ThesisMethod::gaussian;
        EXPECT_EQ(static_cast<double>(more.evaluations), no_bend ? formula * 2 / 3 : formula) << p;
      }
    }
  }
}

TEST(ThesisMethods, cost_a_cubic_span_what_can_be_counted_by_hand) {
  const auto per_span = [](ThesisMethod method) {
    return thesis_gramians(testing::uniform_clamped(3, 21), method).work -
           thesis_gramians(testing::uniform_clamped(3, 20), method).work;
  };
  // Gauss, one of four points: 4 + 3 differences of u and knots; triangle of 1 + 2 + 3 branches,
  // each an addition (the length), a division, two products and, for all but the last of each
  // level, one sum: 7 + 6·4 + 3 = 34. Derivatives 3 + (2 + 3) branches of a product, a division
  // and, but for one of each of 3 levels, a difference: 8·2 + 5 = 21.
  const Work gauss = per_span(ThesisMethod::gaussian);
  EXPECT_EQ(gauss.recursions.total(), 4 * (34 + 21));
  // Four limits; three to shift each abscissa and weight; 3·4 weighted values and 4·10 products and
  // sums.
  EXPECT_EQ(gauss.operations.total(), 4 + 4 * (34 + 21 + 3 + 12 + 80));
  // Analytic: 4 + 7 differences; branches 1 + 2 + 3 + 4·4, of which the last four levels hand
  // nothing to the left of the span (one product less each) and sum at all but one function; third
  // derivative of 1 + 2 + 3 branches.
  const Work analytic = per_span(ThesisMethod::analytic);
  EXPECT_EQ(analytic.recursions.total(), 11 + 22 * 4 - 4 + (0 + 1 + 2 + 4 * 3) + 6 * 2 + 3);
  // 4p − 3 = 9 levels of 4 products and 3 sums, 3 steps, 80 to assemble, 4 weights of a difference
  // and a division.
  EXPECT_EQ(analytic.operations.total(), analytic.recursions.total() + 9 * 7 + 3 + 80 + 4 * 2);
}

TEST(ThesisMethods, save_operations_over_gauss_as_the_thesis_says_and_the_recurrence_saves_more) {
  for (int p = 2; p <= 7; ++p) {
    const auto total = [&](ThesisMethod method) {
      return thesis_gramians(testing::uniform_clamped(p, 200), method).work.operations.total();
    };
    const long recurrence =
        count_operations(testing::uniform_clamped(p, 200), GramianMethod::recurrence).total();
    EXPECT_GT(2 * total(ThesisMethod::gaussian), 3 * total(ThesisMethod::analytic)) << p;
    EXPECT_GT(total(ThesisMethod::analytic), recurrence) << p;
  }
}

}  // namespace
}  // namespace knead::figures
