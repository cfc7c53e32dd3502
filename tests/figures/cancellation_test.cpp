// What docs/gramians/error-analysis.md argues from.
#include "figures/cancellation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "figures/thesis_knots.hpp"
#include "knead/gramian/gramian.hpp"
#include "support/quad_gramian.hpp"

namespace knead::figures {
namespace {

constexpr double epsilon = 2.2e-16;

TEST(Cancellation, weights_and_products_grow_as_the_knots_meet_and_the_entry_does_not) {
  for (const int p : {3, 6, 10}) {
    for (int r = 3; r < 10; ++r) {
      const Cancellation here = cancellation(p, r), next = cancellation(p, r + 1);
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_NEAR(next.weight[k] / here.weight[k], 10, 0.05) << p << " " << r;
        EXPECT_NEAR(next.integral[k] / here.integral[k], 1, 0.02) << p << " " << r;
      }
      EXPECT_LT(here.weight[0] * here.weight[1], 0);  // of opposite signs
      EXPECT_NEAR(here.weight[0] / here.weight[1], -1, 20 * std::pow(10, -r));
    }
  }
}

TEST(Cancellation, error_is_within_the_bound_of_rounded_terms) {
  // A term is wrong by its weight (2 (p + 3) ulp) and its integral (4 (3p + 4) ulp), the bounds of
  // their docstrings.
  for (const int p : {3, 5, 10}) {
    for (int r = 0; r <= 10; ++r) {
      const Cancellation at = cancellation(p, r);
      const double bound = (14 * p + 24) * epsilon * at.condition;
      EXPECT_LE(at.plain, bound) << p << " " << r;
      EXPECT_LE(at.kahan, bound) << p << " " << r;
      EXPECT_LE(at.normalised, bound) << p << " " << r;
    }
  }
}

TEST(Cancellation, kahan_summation_and_normalising_gain_nothing) {
  // Added up over the spacings at which digits are lost: logarithms of the errors, in digits.
  double plain = 0, kahan = 0, normalised = 0;
  int count = 0;
  for (int r = 4; r <= 10; ++r) {
    const Cancellation at = cancellation(3, r);
    plain += std::log10(std::max(at.plain, epsilon));
    kahan += std::log10(std::max(at.kahan, epsilon));
    normalised += std::log10(std::max(at.normalised, epsilon));
    ++count;
  }
  EXPECT_GT(kahan / count, plain / count - 0.1);
  EXPECT_GT(normalised / count, plain / count - 0.5);
  EXPECT_GT(cancellation(3, 10).kahan, 1e-9);
  EXPECT_GT(cancellation(3, 10).normalised, 1e-9);
}

TEST(Cancellation, spares_the_tabulated_entry_as_the_degree_grows_but_not_the_worst) {
  EXPECT_LT(cancellation(10, 10).plain, 1e-12);
  EXPECT_GT(cancellation(10, 10).mirrored,
            1e-5);  // the same entry with integrals from the other side
  for (const int p : {3, 5, 7, 10}) {
    EXPECT_GT(worst_on_thesis_knots(p, 10), 1e-7) << p;
    EXPECT_GT(worst_by_better_side(p, 10), 1e-9) << p;
    EXPECT_GT(worst_on_cluster(p), 0.5) << p;
  }
}

// The page states numbers; they are those that are computed: to the digits stated, and the worst
// entries of whole matrices, which are noise of the analytic method, to their order of magnitude.
TEST(Cancellation, is_what_the_page_says) {
  std::ifstream page(std::string(KNEAD_SOURCE_DIR) + "/docs/gramians/error-analysis.md");
  int rows = 0, worst_rows = 0;
  const auto same = [](double stated, double computed) {
    // One digit is stated; errors below ε are counted as none.
    EXPECT_LE(std::abs(stated - computed), 0.55 * std::max(std::abs(computed), epsilon)) << stated;
  };
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("| ") || std::isdigit(static_cast<unsigned char>(line[2])) == 0) continue;
    std::vector<double> cells;
    std::istringstream cut(line.substr(1));
    for (std::string cell; std::getline(cut, cell, '|');) cells.push_back(std::stod(cell));
    if (cells.size() == 6) {
      const Cancellation at = cancellation(3, static_cast<int>(cells[0]));
      EXPECT_NEAR(cells[1], at.condition, 0.01 * at.condition);
      same(cells[2], epsilon * at.condition);
      same(cells[3], at.plain);
      same(cells[4], at.kahan);
      same(cells[5], at.normalised);
      ++rows;
    } else {
      ASSERT_EQ(cells.size(), 5u) << line;
      const int p = static_cast<int>(cells[0]);
      const double computed[] = {worst_on_thesis_knots(p, 6), worst_on_thesis_knots(p, 8),
                                 worst_on_thesis_knots(p, 10), worst_on_cluster(p)};
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_LE(std::abs(std::log10(cells[k + 1] / computed[k])), 1) << line;
      }
      ++worst_rows;
    }
  }
  EXPECT_EQ(rows, 6);
  EXPECT_EQ(worst_rows, 4);
}

TEST(Cancellation, does_not_touch_the_recurrence) {
  // Ten roundings at each of the 2p levels: 20 p units of half an ulp.
  for (const int p : {3, 5, 10}) {
    for (int r = 0; r <= 10; ++r) {
      const KnotVector knots = thesis_knots(p, r);
      const BandMatrix ours = *gramian(knots, 0, 0, GramianMethod::recurrence);
      const testing::QuadGramian right = testing::quad_gramian(knots, 0, 0);
      for (int i = 0; i < knots.count(); ++i) {
        for (int j = i; j < std::min(knots.count(), i + p + 1); ++j) {
          const auto exact = static_cast<double>(right.value(i, j));
          EXPECT_LE(std::abs(ours(i, j) - exact), 20 * p * epsilon / 2 * exact) << p << " " << r;
        }
      }
    }
  }
}

}  // namespace
}  // namespace knead::figures
