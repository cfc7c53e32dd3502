#include "gramian/operation_count.hpp"

#include <gtest/gtest.h>

#include "support/knot_families.hpp"

namespace knead {
namespace {

/// Per row, away from the ends: the difference of two counts by the rows between them.
double per_row(int degree, GramianMethod method) {
  const OperationCount few = count_operations(testing::uniform_clamped(degree, 100), method);
  const OperationCount many = count_operations(testing::uniform_clamped(degree, 300), method);
  return static_cast<double>(many.total() - few.total()) / 200;
}

TEST(OperationCount, of_the_recurrence_is_the_smallest_at_every_degree) {
  for (int p = 1; p <= 7; ++p) {
    EXPECT_LT(2 * per_row(p, GramianMethod::recurrence), per_row(p, GramianMethod::gauss)) << p;
    EXPECT_LT(per_row(p, GramianMethod::recurrence), per_row(p, GramianMethod::analytic)) << p;
  }
}

// One more point for one of the terms would cost at least 2 (p + 1)(p + 2)/2 operations.
TEST(OperationCount, of_reduced_gauss_is_that_of_the_points_that_the_terms_need) {
  EXPECT_NEAR(per_row(2, GramianMethod::gauss_reduced), 189, 3);
  EXPECT_NEAR(per_row(3, GramianMethod::gauss_reduced), 499, 3);
  EXPECT_NEAR(per_row(5, GramianMethod::gauss_reduced), 1884, 3);
}

TEST(OperationCount, of_a_cubic_row_is_that_of_the_formulas) {
  EXPECT_NEAR(per_row(3, GramianMethod::recurrence), 135, 15);
  const OperationCount count =
      count_operations(testing::uniform_clamped(3, 300), GramianMethod::recurrence);
  EXPECT_NEAR(static_cast<double>(count.divisions), 303 + 2, 4);  // one to a row
}

TEST(OperationCount, grows_linearly_with_the_number_of_spans) {
  for (const GramianMethod method :
       {GramianMethod::gauss, GramianMethod::analytic, GramianMethod::recurrence}) {
    const long a = count_operations(testing::uniform_clamped(4, 128), method).total();
    const long b = count_operations(testing::uniform_clamped(4, 256), method).total();
    const long c = count_operations(testing::uniform_clamped(4, 512), method).total();
    EXPECT_NEAR(static_cast<double>(c - b), 2.0 * static_cast<double>(b - a),
                0.001 * static_cast<double>(c));
  }
}

}  // namespace
}  // namespace knead
