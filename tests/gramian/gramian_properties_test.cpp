// What holds for Gramians of any knots, whatever they are computed by.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "knead/gramian/gramian.hpp"
#include "knead/spline/basis.hpp"
#include "support/knot_families.hpp"
#include "support/numbers.hpp"

namespace knead {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr GramianMethod all_methods[] = {GramianMethod::gauss, GramianMethod::gauss_reduced,
                                         GramianMethod::analytic, GramianMethod::recurrence};

/// Every family with every method that is fit for it, and the accuracy that may be asked of the
/// method.
template <class Check>
void for_all_methods(Check check) {
  for (const int p : testing::checked_degrees) {
    for (const auto& family : testing::knot_families(p)) {
      for (const GramianMethod method : all_methods) {
        const bool lossy = method == GramianMethod::analytic;
        if (lossy && (p > 5 || !family.ordinary())) continue;
        SCOPED_TRACE(family.name + ", " + std::string(name(method)));
        check(family.knots, method, lossy ? 1e-10 : 1e-13);
      }
    }
  }
}

using testing::largest;

/// The largest entry of a difference of two G^ab, each beside sqrt(G^aa_ii G^bb_jj), which by
/// Cauchy and Schwarz bounds G^ab_ij and is the size of what may have cancelled in it (for a lossy
/// method beside the largest of these).
double largest_beside(const MatrixXd& difference, const KnotVector& knots, int a, int b,
                      GramianMethod method) {
  const VectorXd rows = gramian(knots, a, a, method)->dense().diagonal().cwiseSqrt();
  const VectorXd columns = gramian(knots, b, b, method)->dense().diagonal().cwiseSqrt();
  MatrixXd size = rows * columns.transpose();
  if (method == GramianMethod::analytic) size.setConstant(largest(size));
  double worst = 0;
  for (Eigen::Index k = 0; k < size.size(); ++k) {
    if (difference(k) != 0) worst = std::max(worst, std::abs(difference(k)) / size(k));
  }
  return worst;
}

TEST(Gramian, is_symmetric_and_transposes_with_its_orders) {
  for_all_methods([](const KnotVector& knots, GramianMethod method, double tolerance) {
    for (int a = 0; a <= 2; ++a) {
      EXPECT_EQ(gramian(knots, a, a, method)->symmetry(), BandSymmetry::symmetric);
      for (int b = 0; b < a; ++b) {
        const MatrixXd ab = gramian(knots, a, b, method)->dense(),
                       ba = gramian(knots, b, a, method)->dense();
        EXPECT_LE(largest_beside(ab - ba.transpose(), knots, a, b, method), tolerance) << a << b;
      }
    }
  });
}

TEST(Gramian, of_all_four_terms_at_once_is_that_of_each) {
  for_all_methods([](const KnotVector& knots, GramianMethod method, double) {
    const GramianSet set = *gramians(knots, method);
    EXPECT_EQ(set.g00.dense(), gramian(knots, 0, 0, method)->dense());
    EXPECT_EQ(set.g11.dense(), gramian(knots, 1, 1, method)->dense());
    EXPECT_EQ(set.g22.dense(), gramian(knots, 2, 2, method)->dense());
    EXPECT_EQ(set.g10.dense(), gramian(knots, 1, 0, method)->dense());
  });
}

TEST(Gramian, rows_of_00_sum_to_the_areas_and_rows_of_derivatives_to_zero) {
  for_all_methods([](const KnotVector& knots, GramianMethod method, double tolerance) {
    const GramianSet set = *gramians(knots, method);
    const VectorXd area = set.g00.dense().rowwise().sum();
    EXPECT_NEAR(area.sum(), knots.domain().length(), tolerance * knots.domain().length());
    if (knots.clamped()) {
      for (int i = 0; i < knots.count(); ++i) {  // thesis Thm 5.2: d(i,p+1)/(p+1)
        const double exact = (knots[i + knots.degree() + 1] - knots[i]) / (knots.degree() + 1);
        EXPECT_NEAR(area[i], exact, tolerance * largest(set.g00.dense()) * 10);
      }
    }
    EXPECT_LE(largest(set.g11.dense().rowwise().sum()), tolerance * largest(set.g11.dense()));
    EXPECT_LE(largest(set.g22.dense().rowwise().sum()), tolerance * largest(set.g22.dense()));
    EXPECT_LE(largest(set.g10.dense().colwise().sum()), tolerance);
  });
}

TEST(Gramian, of_second_derivatives_annihilates_straight_lines) {
  for_all_methods([](const KnotVector& knots, GramianMethod method, double tolerance) {
    if (knots.degree() < 2) return;
    const MatrixXd g22 = gramian(knots, 2, 2, method)->dense();
    VectorXd line(knots.count());
    for (int i = 0; i < knots.count();
         ++i) {  // Greville abscissae from that of N_0, each a sum of differences
      double sum = 0;
      for (int k = 1; k <= knots.degree(); ++k) sum += knots[i + k] - knots[k];
      line[i] = sum / knots.degree();
    }
    EXPECT_LE(largest(g22 * line), tolerance * largest(g22) * largest(line));
  });
}

TEST(Gramian, of_degree_one_has_no_second_derivatives) {
  for (const auto& [name, knots] : testing::knot_families(1)) {
    for (const GramianMethod method : all_methods) {
      for (int b = 0; b <= 2; ++b) {
        EXPECT_EQ(largest(gramian(knots, 2, b, method)->dense()), 0) << name;
        EXPECT_EQ(largest(gramian(knots, b, 2, method)->dense()), 0) << name;
      }
    }
  }
}

TEST(Gramian, of_equal_orders_is_positive_semidefinite) {
  for_all_methods([](const KnotVector& knots, GramianMethod method, double tolerance) {
    for (int a = 0; a <= 2; ++a) {
      const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(gramian(knots, a, a, method)->dense(),
                                                          Eigen::EigenvaluesOnly);
      EXPECT_GE(eigen.eigenvalues().minCoeff(),
                -tolerance * std::max(0.0, eigen.eigenvalues().maxCoeff()));
    }
  });
}

TEST(Gramian, scales_with_the_knots_to_the_last_bit_for_powers_of_two) {
  for_all_methods([](const KnotVector& knots, GramianMethod method, double) {
    std::vector<double> scaled(knots.knots().begin(), knots.knots().end());
    for (double& x : scaled) x *= 4;
    const KnotVector wide = testing::make_knots(knots.degree(), scaled);
    for (int a = 0; a <= 2; ++a) {
      for (int b = 0; b <= 2; ++b) {
        const MatrixXd narrow = gramian(knots, a, b, method)->dense();
        if (knots.degree() > 7 && narrow.cwiseAbs().minCoeff() < 1e-280)
          continue;  // denormal numbers do not scale
        // Of an entry that vanishes between repeated knots their splitting by 2^-300 may be left.
        const auto settled = [](const MatrixXd& matrix) {
          return MatrixXd((matrix.array().abs() > 1e-80 * largest(matrix)).select(matrix, 0));
        };
        EXPECT_EQ(settled(gramian(wide, a, b, method)->dense()),
                  settled(narrow * std::pow(4, 1 - a - b)))
            << a << b;
      }
    }
  });
}

TEST(Gramian, is_mirrored_with_the_knots) {
  for_all_methods([](const KnotVector& knots, GramianMethod method, double tolerance) {
    std::vector<double> turned(knots.knots().rbegin(), knots.knots().rend());
    for (double& x : turned) x = -x;
    const KnotVector mirrored = testing::make_knots(knots.degree(), turned);
    for (int a = 0; a <= 2; ++a) {
      for (int b = 0; b <= a; ++b) {
        const MatrixXd there = gramian(knots, a, b, method)->dense();
        const MatrixXd back = gramian(mirrored, a, b, method)->dense().reverse();
        const double sign = (a + b) % 2 == 0 ? 1 : -1;
        EXPECT_LE(largest_beside(there - sign * back, knots, a, b, method), tolerance) << a << b;
      }
    }
  });
}

// ∫ N_i' N_j + N_i N_j' over a span is N_i N_j at its ends.
TEST(Gramian, obeys_integration_by_parts) {
  for_all_methods([](const KnotVector& knots, GramianMethod method, double tolerance) {
    const int n = knots.count(), p = knots.degree();
    MatrixXd ends = MatrixXd::Zero(n, n);
    for (const int s : knots.spans()) {
      for (const double sign : {-1.0, 1.0}) {
        VectorXd values = VectorXd::Zero(n);
        basis_values(knots, s, sign < 0 ? knots[s] : knots[s + 1], values.data() + s - p);
        ends += sign * values * values.transpose();
      }
    }
    const MatrixXd g10 = gramian(knots, 1, 0, method)->dense();
    EXPECT_LE(largest(g10 + g10.transpose() - ends), tolerance);
  });
}

// N_i' = p (N_{i,p-1} / d(i,p) − N_{i+1,p-1} / d(i+1,p)) span by span.
TEST(Gramian, of_first_derivatives_comes_from_the_one_of_lower_degree) {
  for_all_methods([](const KnotVector& knots, GramianMethod method, double tolerance) {
    const int n = knots.count(), p = knots.degree();
    if (p < 2 || knots.max_interior_multiplicity() > p) return;
    // The inner knots are those of degree p − 1 with functions N_1 … N_{n-1}; N_0 and N_n live
    // outside the domain.
    const auto inner =
        KnotVector::create(p - 1, {knots.knots().begin() + 1, knots.knots().end() - 1});
    ASSERT_TRUE(inner.has_value());
    const MatrixXd lower = gramian(*inner, 0, 0, method)->dense();
    MatrixXd difference = MatrixXd::Zero(n - 1, n);
    for (int k = 1; k < n; ++k) {
      const double length = knots[k + p] - knots[k];
      if (length > 0) difference(k - 1, k) = p / length, difference(k - 1, k - 1) = -p / length;
    }
    const MatrixXd g11 = gramian(knots, 1, 1, method)->dense();
    EXPECT_LE(largest(difference.transpose() * lower * difference - g11),
              10 * tolerance * largest(g11));
  });
}

TEST(Gramian, refuses_orders_it_does_not_know) {
  const KnotVector knots = testing::uniform_clamped(3, 4);
  for (const auto& [a, b] : {std::pair{max_degree + 1, 0}, {0, max_degree + 1}, {-1, 0}, {0, -1}}) {
    const auto refused = gramian(knots, a, b);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().kind, ErrorKind::usage);
  }
}

TEST(GramianMethod, is_known_by_its_name) {
  for (const GramianMethod method : all_methods) {
    EXPECT_EQ(gramian_method(name(method)), method);
  }
  const auto unknown = gramian_method("simpson");
  ASSERT_FALSE(unknown.has_value());
  EXPECT_EQ(unknown.error().kind, ErrorKind::usage);
  EXPECT_NE(unknown.error().message().find("gauss"), std::string::npos);
}

}  // namespace
}  // namespace knead
