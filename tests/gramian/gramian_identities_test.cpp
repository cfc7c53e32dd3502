// What a change of the knots does to Gramians: maps of the line, and knots put in.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "knead/gramian/gramian.hpp"
#include "support/knot_families.hpp"
#include "support/listed_families.hpp"

namespace knead {
namespace {

using Eigen::MatrixXd;

constexpr GramianMethod stable_methods[] = {GramianMethod::gauss, GramianMethod::gauss_reduced,
                                            GramianMethod::recurrence};
constexpr int terms[5][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {2, 2}};

/// Knots that stay exact under maps by small integers: multiples of 1/4, of any multiplicity,
/// clamped or not.
KnotVector quarter_knots(std::mt19937_64& random, int p) {
  const auto integer = [&](int a, int b) {
    return std::uniform_int_distribution<int>(a, b)(random);
  };
  std::vector<double> breaks{integer(-8, 8) / 4.0};
  std::vector<int> multiplicity{1};
  for (int k = integer(1, 8); k > 0; --k) {
    breaks.push_back(breaks.back() + integer(1, 12) / 4.0);
    multiplicity.push_back(integer(0, 2) == 0 ? integer(1, p + 1) : 1);
  }
  if (integer(0, 1) == 0) return testing::clamped_knots(p, breaks, multiplicity);
  std::vector<double> knots;
  for (int k = p; k > 0; --k) knots.push_back(breaks.front() - k * 0.25);
  for (std::size_t k = 0; k < breaks.size(); ++k) {
    const bool end = k == 0 || k + 1 == breaks.size();
    knots.insert(knots.end(), static_cast<std::size_t>(end ? 1 : multiplicity[k]), breaks[k]);
  }
  for (int k = 1; k <= p; ++k) knots.push_back(breaks.back() + k * 0.5);
  return testing::make_knots(p, knots);
}

// u → c u + t takes G^ab to c^(1 − a − b) G^ab.
TEST(Gramian, follows_affine_maps_of_the_knots) {
  for (const int p : testing::checked_degrees) {
    for (int k = 0; k < 20; ++k) {
      const unsigned seed = static_cast<unsigned>(1000 * p + k);
      std::mt19937_64 random(seed);
      const KnotVector knots = quarter_knots(random, p);
      const double c = std::uniform_int_distribution<int>(3, 9)(random);
      const double t = std::uniform_int_distribution<int>(-1000, 1000)(random) / 4.0;
      std::vector<double> mapped(knots.knots().begin(), knots.knots().end());
      for (double& x : mapped) x = c * x + t;
      const KnotVector there = testing::make_knots(p, mapped);
      for (const GramianMethod method : stable_methods) {
        for (const auto& [a, b] : terms) {
          const MatrixXd before = gramian(knots, a, b, method)->dense(),
                         after = gramian(there, a, b, method)->dense();
          const MatrixXd rows = gramian(knots, a, a, method)->dense(),
                         columns = gramian(knots, b, b, method)->dense();
          const MatrixXd scale =
              rows.diagonal().cwiseSqrt() * columns.diagonal().cwiseSqrt().transpose();
          const MatrixXd error = (after * std::pow(c, a + b - 1) - before).cwiseAbs();
          EXPECT_LE((error - 1e-13 * scale).maxCoeff(), 0)
              << name(method) << " " << a << b << ", seed " << seed;
        }
      }
    }
  }
}

struct Refinement {
  KnotVector knots;
  MatrixXd matrix;  ///< R: N_i = Σ_k R(k, i) M_k for the functions N before and M after
};

/// One knot at u in [x_s, x_{s+1}), where it may stand already (W. Boehm 1980).
Refinement insert(const KnotVector& x, double u, int s) {
  const int p = x.degree(), n = x.count(), m = x.multiplicity(u);
  std::vector<double> knots(x.knots().begin(), x.knots().end());
  knots.insert(knots.begin() + s + 1, u);
  MatrixXd r = MatrixXd::Zero(n + 1, n);
  for (int k = 0; k <= n; ++k) {
    if (k <= s - p) {
      r(k, k) = 1;
    } else if (k > s - m) {
      r(k, k - 1) = 1;
    } else {
      const double length = x[k + p] - x[k];
      r(k, k) = (u - x[k]) / length;
      r(k, k - 1) = (x[k + p] - u) / length;
    }
  }
  return {testing::make_knots(p, std::move(knots)), std::move(r)};
}

void expect_refined(const KnotVector& knots, double u, int s, GramianMethod method,
                    double tolerance) {
  const Refinement fine = insert(knots, u, s);
  for (const auto& [a, b] : terms) {
    const MatrixXd before = gramian(knots, a, b, method)->dense();
    const MatrixXd after = gramian(fine.knots, a, b, method)->dense();
    const MatrixXd back = fine.matrix.transpose() * after * fine.matrix;
    // Each sum beside the sizes that its terms may have (Cauchy and Schwarz): where knots lie close
    // these are large and cancel.
    MatrixXd size = gramian(fine.knots, a, a, method)->dense().diagonal().cwiseSqrt() *
                    gramian(fine.knots, b, b, method)->dense().diagonal().cwiseSqrt().transpose();
    if (method == GramianMethod::analytic) size.setConstant(size.maxCoeff());
    const MatrixXd scale = fine.matrix.transpose() * size * fine.matrix;
    const double worst = ((back - before).cwiseAbs() - tolerance * scale).maxCoeff();
    EXPECT_LE(worst, 1e-290) << "G" << a << b << " by " << name(method) << ", u = " << u;
  }
}

// The coarse basis in terms of the fine one, G = Rᵀ G' R.
TEST(Gramian, of_the_coarse_basis_comes_from_that_of_a_refined_one) {
  for (const int p : testing::checked_degrees) {
    for (std::size_t family = 0; family < testing::listed_families.size(); ++family) {
      const unsigned seed = static_cast<unsigned>(1000 * p) + static_cast<unsigned>(family);
      SCOPED_TRACE(std::string(testing::listed_families[family]) + ", p = " + std::to_string(p) +
                   ", seed " + std::to_string(seed));
      std::mt19937_64 random(seed);
      const KnotVector knots = testing::random_member(random, p, family);
      for (const GramianMethod method : stable_methods) {
        std::vector<int> spans = knots.spans();
        std::ranges::shuffle(spans, random);
        spans.resize(std::min<std::size_t>(spans.size(), 3));
        for (const int s : spans) {
          const double t = std::uniform_real_distribution<double>(0.01, 0.99)(random);
          const double inside = knots[s] + t * (knots[s + 1] - knots[s]);
          if (knots[s] < inside && inside < knots[s + 1])
            expect_refined(knots, inside, s, method, 1e-13);
          if (s > p && knots.multiplicity(knots[s]) <= p && knots[s] > knots.domain().lower) {
            expect_refined(knots, knots[s], s, method, 1e-13);
          }
        }
      }
    }
  }
}

TEST(Gramian, by_analytic_of_the_coarse_basis_comes_from_that_of_a_refined_one_on_ordinary_knots) {
  for (int p = 1; p <= 5; ++p) {
    for (const auto& family : testing::knot_families(p)) {
      if (!family.ordinary()) continue;
      SCOPED_TRACE(family.name);
      const KnotVector& knots = family.knots;
      for (const int s : knots.spans()) {
        expect_refined(knots, (knots[s] + knots[s + 1]) / 2, s, GramianMethod::analytic, 1e-10);
      }
    }
  }
}

}  // namespace
}  // namespace knead
