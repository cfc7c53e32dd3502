#include "knead/spline/basis.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "figures/csv.hpp"
#include "support/knot_families.hpp"
#include "support/quad_gramian.hpp"

namespace knead {
namespace {

using testing::Quad;

/// Right minus left limit of N_i^(r) at x, from the pieces of the spans beside it.
Quad quad_jump(const KnotVector& knots, int i, int r, double x) {
  const int p = knots.degree();
  Quad jump = 0;
  for (int s = i; s <= i + p; ++s) {
    if (!(knots[s] < knots[s + 1])) continue;
    if (knots[s] == x) jump += testing::quad_basis(knots, i, p, r, s, Quad(x));
    if (knots[s + 1] == x) jump -= testing::quad_basis(knots, i, p, r, s, Quad(x));
  }
  return jump;
}

TEST(DerivativeJumps, are_the_differences_of_the_one_sided_limits) {
  for (const int p : {1, 2, 3, 4, 6}) {
    for (const auto& [name, knots] : testing::knot_families(p)) {
      for (int i = 0; i < knots.count(); ++i) {
        const auto all = derivative_jumps(knots, i);
        for (const auto& at : all) {
          for (int r = 0; r <= p + 1; ++r) {
            const Quad exact = quad_jump(knots, i, r, at.knot);
            const double jump = at.of_order(r, p);
            if (r == p - at.multiplicity + 1) {
              EXPECT_LE(static_cast<double>(testing::magnitude(Quad(jump) - exact) /
                                            testing::magnitude(exact)),
                        2 * (p + 3) * 2.3e-16)
                  << name << " N_" << i << " order " << r;
            } else if (r < p - at.multiplicity + 1 || r > p) {
              EXPECT_EQ(jump, 0);
            } else {
              double size = 0;
              for (const auto& other : all) size = std::max(size, std::abs(other.of_order(r, p)));
              EXPECT_NEAR(jump, static_cast<double>(exact), 1e-12 * size)
                  << name << " N_" << i << " order " << r;
            }
          }
        }
      }
    }
  }
}

TEST(DerivativeJumps, stand_at_the_distinct_knots_of_the_support_and_use_them_all) {
  for (int p = 1; p <= max_degree; ++p) {
    for (const auto& [name, knots] : testing::knot_families(p)) {
      for (int i = 0; i < knots.count(); ++i) {
        int total = 0;
        double before = -INFINITY;
        for (const auto& at : derivative_jumps(knots, i)) {
          EXPECT_GT(at.knot, before) << name;
          before = at.knot;
          EXPECT_EQ(static_cast<int>(at.jumps.size()), at.multiplicity);
          total += at.multiplicity;
        }
        EXPECT_EQ(total, p + 2) << name;
      }
    }
  }
}

TEST(DerivativeJumps, weigh_the_impulses_and_their_derivatives_up_to_the_last) {
  EXPECT_EQ((KnotJumps{0, 3, {4, 0, 2}}.impulses()), (std::vector<double>{2, 0, 4}));
  EXPECT_EQ((KnotJumps{0, 3, {0, 4, 0}}.impulses()), (std::vector<double>{0, 4}));
  EXPECT_TRUE((KnotJumps{0, 1, {0}}.impulses().empty()));
}

TEST(DerivativeJumps, of_the_highest_order_sum_to_zero) {
  for (const int p : {2, 3, 5}) {
    const KnotVector knots = testing::thesis_knots(p, 1);
    for (int i = 0; i < knots.count(); ++i) {
      double sum = 0, size = 0;
      for (const auto& at : derivative_jumps(knots, i))
        sum += at.jumps.back(), size += std::abs(at.jumps.back());
      EXPECT_NEAR(sum, 0, 1e-14 * size);
    }
  }
}

TEST(DerivativeJumps, are_the_dirac_weights_of_thesis_table_5_16) {
  const auto rows = figures::read_csv(KNEAD_SOURCE_DIR "/apps/figures/data/table_5_16.csv");
  ASSERT_FALSE(rows.empty());
  std::vector<double> breaks;
  for (int k = 0; k <= 17; ++k) breaks.push_back(k == 7 ? 6 + 1e-10 : k);
  const auto jumps = derivative_jumps(testing::clamped_knots(10, breaks), 15);
  for (const auto& row : rows) {
    const double exact = std::stod(row.at("dirac_weight"));
    // 6 + 1e-10 as a double is off by up to half an ulp of 6, which is 4e-6 of the gap.
    EXPECT_NEAR(jumps.at(static_cast<std::size_t>(std::stoi(row.at("knot_index")))).jumps.back(),
                exact, 5e-6 * std::abs(exact));
  }
}

}  // namespace
}  // namespace knead
