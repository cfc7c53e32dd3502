#include "knead/spline/basis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "figures/csv.hpp"
#include "support/knot_families.hpp"
#include "support/quad_gramian.hpp"

namespace knead {
namespace {

using testing::Quad;

constexpr double ulp = std::numeric_limits<double>::epsilon();

/// The m-fold integral ∫ (u − v)^(m−1)/(m−1)! N_i(v) dv (Cauchy) in quadruple precision, Gauss on
/// every span.
Quad quad_integral(const KnotVector& knots, int i, int m, double u) {
  const int p = knots.degree();
  const testing::QuadRule rule = testing::quad_rule((p + m) / 2 + 1);
  Quad sum = 0;
  for (int s = i; s <= i + p; ++s) {
    const Quad a = knots[s], b = std::min(knots[s + 1], u);
    if (!(b > a)) continue;
    for (std::size_t g = 0; g < rule.t.size(); ++g) {
      const Quad v = a + (b - a) * rule.t[g];
      Quad kernel = 1;
      for (int k = 1; k < m; ++k) kernel *= (Quad(u) - v) / k;
      sum += (b - a) * rule.weight[g] * kernel * testing::quad_basis(knots, i, p, 0, s, v);
    }
  }
  return sum;
}

/// Points left of the support, on every span, at every knot, and right of it.
std::vector<double> probes(const KnotVector& knots, int i) {
  const int p = knots.degree();
  const double a = knots[i], b = knots[i + p + 1];
  std::vector<double> points{a - 1, b + 0.3 * (b - a), b + 5 * (b - a)};
  for (int s = i; s <= i + p + 1; ++s) {
    points.push_back(knots[s]);
    if (s <= i + p) points.push_back(knots[s] + 0.375 * (knots[s + 1] - knots[s]));
  }
  return points;
}

TEST(BasisIntegral, is_exact_to_its_bound_everywhere_on_the_line) {
  for (const int p : {1, 2, 3, 4, 6}) {
    for (const auto& [name, knots] : testing::knot_families(p)) {
      for (int i = 0; i < knots.count(); i += 2) {
        for (const double u : probes(knots, i)) {
          for (const int m : {1, 2, 4, p + 1}) {
            const Quad exact = quad_integral(knots, i, m, u);
            if (exact != 0 && exact < Quad(1e-280)) continue;
            const Quad error = testing::magnitude(Quad(basis_integral(knots, i, m, u)) - exact);
            EXPECT_LE(static_cast<double>(error),
                      4 * (p + 2 * m + 2) * ulp * static_cast<double>(exact))
                << name << ", I^" << m << " N_" << i << "(" << u << ")";
          }
        }
      }
    }
  }
}

TEST(BasisIntegral, over_the_line_is_the_length_of_the_support_by_the_order) {
  for (int p = 1; p <= max_degree; ++p) {
    for (const auto& [name, knots] : testing::knot_families(p)) {
      for (int i = 0; i < knots.count(); ++i) {
        const double area = (knots[i + p + 1] - knots[i]) / (p + 1);
        EXPECT_NEAR(basis_integral(knots, i, 1, knots.knots().back() + 1), area, 8 * p * ulp * area)
            << name;
      }
    }
  }
}

TEST(BasisIntegral, of_no_order_is_the_function) {
  const KnotVector knots = testing::thesis_knots(4, 2);
  EXPECT_EQ(basis_integral(knots, 3, 0, 2.5), basis_function(knots, 3, 0, 2.5));
}

TEST(BasisIntegral, gives_the_fourth_integrals_of_thesis_table_5_15) {
  const auto rows = figures::read_csv(KNEAD_SOURCE_DIR "/apps/figures/data/table_5_15.csv");
  ASSERT_FALSE(rows.empty());
  for (const auto& row : rows) {
    const KnotVector knots = testing::thesis_knots(3, std::stoi(row.at("r")));
    const std::string& at = row.at("knot");
    const double u = at == "6+10^-r" ? knots[10] : std::stod(at),
                 exact = std::stod(row.at("exact"));
    EXPECT_NEAR(basis_integral(knots, std::stoi(row.at("i")), 4, u), exact,
                1e-15 * exact + 1e-5 * ulp)
        << at;
  }
}

TEST(BasisFunction, is_the_piece_of_its_span_and_zero_above_the_degree) {
  for (const int p : {1, 2, 3, 5, 7}) {
    for (const auto& family : testing::knot_families(p)) {
      const KnotVector& knots = family.knots;
      for (const int s : knots.spans()) {
        for (const double t : {0.0, 0.25, 1.0}) {
          const double u = t == 1 ? knots[s + 1] : knots[s] + t * (knots[s + 1] - knots[s]);
          const Side side = t == 1 ? Side::left : Side::right;
          // On short spans beside long ones higher derivatives cancel whatever they are computed
          // by.
          for (int d = 0; d <= (family.ordinary() ? p + 1 : 0); ++d) {
            const std::vector<Quad> exact = testing::quad_span_basis(knots, p, d, s, Quad(u));
            double size = 0;  // the largest of that order: what differences may have cancelled from
            for (const Quad value : exact)
              size = std::max(size, std::abs(static_cast<double>(value)));
            for (int r = 0; r <= p; ++r) {
              const double expected = static_cast<double>(exact[static_cast<std::size_t>(r)]);
              EXPECT_NEAR(basis_function(knots, s - p + r, d, u, side), expected, 1e-13 * size)
                  << family.name << " " << u;
            }
          }
        }
      }
    }
  }
}

TEST(BasisFunction, is_zero_outside_of_its_support) {
  const KnotVector knots = testing::uniform_unclamped(3, 5);
  EXPECT_EQ(basis_function(knots, 2, 0, 1.9), 0);
  EXPECT_EQ(basis_function(knots, 2, 0, 6.1), 0);
  EXPECT_GT(basis_function(knots, 0, 0, 1.5), 0);  // left of the domain, but on the support
  EXPECT_EQ(basis_function(knots, 0, 4, 1.5), 0);
}

TEST(ExtendedKnots, repeat_the_ends) {
  const KnotVector knots = testing::make_knots(1, {0, 1, 2, 3});
  EXPECT_EQ(extended_knots(knots, 1, 2), (std::vector<double>{0, 0, 1, 2, 3, 3, 3}));
}

}  // namespace
}  // namespace knead
