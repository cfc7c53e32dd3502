#include "knead/spline/basis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "quad_reference.hpp"
#include "support/knot_families.hpp"
#include "support/long_run.hpp"
#include "support/numbers.hpp"
#include "support/quad_gramian.hpp"

namespace knead {
namespace {

using testing::Quad;

using testing::epsilon;

/// Parameters of one span: its ends, their neighbours in double, and places between.
std::vector<double> parameters_of(const KnotVector& knots, int s) {
  const double a = knots[s], b = knots[s + 1];
  std::vector<double> result = {a, std::nextafter(a, b), std::nextafter(b, a), b};
  for (const double t : {0.1, 0.25, 0.5, 0.7, 0.95})
    result.push_back(std::clamp(a + t * (b - a), a, b));
  return result;
}

class Basis : public ::testing::TestWithParam<int> {
 protected:
  /// Calls visit(name, knots, span, u) at every kind of place of every kind of knot vector of the
  /// degree; where the sample is one of several, only there.
  template <class Visit>
  void everywhere(Visit visit, testing::Sample sample = testing::Sample(1)) const {
    const auto visit_all = [&](const std::string& name, const KnotVector& knots) {
      for (const int s : knots.spans()) {
        for (const double u : parameters_of(knots, s)) {
          if (sample.next()) visit(name, knots, s, u);
        }
      }
    };
    for (const auto& [name, knots] : testing::knot_families(GetParam())) visit_all(name, knots);
    std::mt19937_64 random(static_cast<unsigned>(GetParam()));
    for (int k = 0; k < 20; ++k)
      visit_all("random " + std::to_string(k), testing::random_knots(random, GetParam()));
  }
};

TEST_P(Basis, ValuesAreNonNegativeAndSumToOne) {
  const int p = GetParam();
  everywhere([p](const std::string& name, const KnotVector& knots, int s, double u) {
    double values[max_degree + 1], sum = 0;
    basis_values(knots, s, u, values);
    for (int r = 0; r <= p; ++r) {
      ASSERT_GE(values[r], 0) << name << " at " << u;
      sum += values[r];
    }
    ASSERT_NEAR(sum, 1, 4 * (p + 1) * epsilon) << name << " at " << u;
  });
}

TEST_P(Basis, ValuesAreExactToFourUlpPerDegree) {
  const int p = GetParam();
  everywhere([p](const std::string& name, const KnotVector& knots, int s, double u) {
    double values[max_degree + 1];
    basis_values(knots, s, u, values);
    const auto exact = testing::quad_span_basis(knots, p, 0, s, u);
    for (int r = 0; r <= p; ++r) {
      const Quad value = exact[static_cast<std::size_t>(r)];
      // Products may leave the range of normal numbers; there the error is absolute.
      const double bound = 4 * p * epsilon * static_cast<double>(value) + 1e-290;
      ASSERT_LE(static_cast<double>(testing::magnitude(values[r] - value)), bound)
          << name << " at " << u;
    }
  });
}

TEST_P(Basis, DerivativesOfEveryOrderAreExactToRounding) {
  const int p = GetParam(), order = p + 2;
  // The nine places of a span have no factor in common with seven: every knot vector has its turn,
  // and every place.
  const testing::Sample sample(p <= 6 ? 1 : 7);
  const auto check = [=](const std::string& name, const KnotVector& knots, int s, double u) {
    std::vector<double> got(static_cast<std::size_t>((order + 1) * (p + 1)));
    basis_derivatives(knots, s, u, order, got.data());
    for (int d = 0; d <= order; ++d) {
      const auto exact = testing::quad_span_basis(knots, p, d, s, u);
      const auto size = testing::quad_span_basis(knots, p, d, s, u, testing::Terms::magnitudes);
      for (int r = 0; r <= p; ++r) {
        const auto at = static_cast<std::size_t>(r);
        const double error = static_cast<double>(
            testing::magnitude(got[static_cast<std::size_t>(d * (p + 1) + r)] - exact[at]));
        ASSERT_LE(error, 4 * (p + 1) * epsilon * static_cast<double>(size[at]) + 1e-290)
            << name << " at " << u << ", derivative " << d << " of function " << r;
      }
    }
  };
  everywhere(check, sample);
}

TEST_P(Basis, DerivativesAboveTheDegreeAreZero) {
  const int p = GetParam();
  everywhere([p](const std::string& name, const KnotVector& knots, int s, double u) {
    std::vector<double> got(static_cast<std::size_t>((p + 4) * (p + 1)));
    basis_derivatives(knots, s, u, p + 3, got.data());
    for (int k = (p + 1) * (p + 1); k < (p + 4) * (p + 1); ++k)
      ASSERT_EQ(got[static_cast<std::size_t>(k)], 0) << name;
  });
}

TEST_P(Basis, ValuesAreTheZerothDerivatives) {
  const int p = GetParam();
  everywhere([p](const std::string& name, const KnotVector& knots, int s, double u) {
    double values[max_degree + 1], derivatives[3 * (max_degree + 1)];
    basis_values(knots, s, u, values);
    basis_derivatives(knots, s, u, 2, derivatives);
    for (int r = 0; r <= p; ++r) ASSERT_EQ(values[r], derivatives[r]) << name;
  });
}

/// Across a knot of multiplicity m the derivatives 0 … p − m are continuous, and the next one of
/// some function jumps.
TEST_P(Basis, SmoothnessAtAKnotIsDegreeMinusMultiplicity) {
  const int p = GetParam();
  for (const auto& [name, knots] : testing::knot_families(p)) {
    const auto spans = knots.spans();
    for (std::size_t k = 1; k < spans.size(); ++k) {
      const double u = knots[spans[k]];
      const int left = knots.find_span(u, Side::left), right = knots.find_span(u, Side::right);
      ASSERT_EQ(left, spans[k - 1]) << name;
      ASSERT_EQ(right, spans[k]) << name;
      const int m = knots.multiplicity(u);
      ASSERT_EQ(right - left, m) << name;
      std::vector<double> before(static_cast<std::size_t>((p + 1) * (p + 1))), after = before;
      basis_derivatives(knots, left, u, p, before.data());
      basis_derivatives(knots, right, u, p, after.data());
      for (int d = 0; d <= std::min(p, p - m + 1); ++d) {
        const auto size_left =
                       testing::quad_span_basis(knots, p, d, left, u, testing::Terms::magnitudes),
                   size_right =
                       testing::quad_span_basis(knots, p, d, right, u, testing::Terms::magnitudes);
        double jump = 0;
        for (int i = left - p; i <= right; ++i) {
          const bool in_left = i <= left, in_right = i >= right - p;
          const auto l = static_cast<std::size_t>(i - left + p),
                     r = static_cast<std::size_t>(i - right + p);
          const double difference =
              (in_right ? after[static_cast<std::size_t>(d * (p + 1)) + r] : 0) -
              (in_left ? before[static_cast<std::size_t>(d * (p + 1)) + l] : 0);
          const double size =
              static_cast<double>((in_left ? size_left[l] : 0) + (in_right ? size_right[r] : 0));
          if (d <= p - m) {
            ASSERT_LE(std::abs(difference), 8 * (p + 1) * epsilon * size + 1e-290)
                << name << " at " << u;
          } else if (size > 0) {
            jump = std::max(jump, std::abs(difference) / size);
          }
        }
        if (d == p - m + 1) {
          ASSERT_GT(jump, 1e-9) << name << " at " << u << " should jump in derivative " << d;
        }
      }
    }
  }
}

TEST_P(Basis, MarsdensIdentityHolds) {
  // (y − u)^p = Σ_i N_i(u) Π_{k=1..p} (y − x_{i+k}), and its derivatives in u (Marsden 1970).
  const int p = GetParam();
  // Differences of differences lose more at degrees above 15: up to 23 (p + 1) roundings there,
  // below 16 elsewhere.
  const double roundings = p <= 15 ? 16 : 32;
  const KnotVector knots =
      testing::clamped_knots(p, {0, 1, 2, 4, 5}, {0, 1, std::min(2, p + 1), 1, 0});
  for (const int s : knots.spans()) {
    for (const double u : parameters_of(knots, s)) {
      std::vector<double> got(static_cast<std::size_t>((p + 1) * (p + 1)));
      basis_derivatives(knots, s, u, p, got.data());
      for (const double y : {-1.0, 2.5, 6.0}) {
        double falling = 1;
        for (int d = 0; d <= p; falling *= p - d, ++d) {
          double sum = 0, size = 0;
          for (int r = 0; r <= p; ++r) {
            double dual = 1;
            for (int k = 1; k <= p; ++k) dual *= y - knots[s - p + r + k];
            sum += got[static_cast<std::size_t>(d * (p + 1) + r)] * dual;
            size += std::abs(got[static_cast<std::size_t>(d * (p + 1) + r)] * dual);
          }
          const double expected = falling * std::pow(y - u, p - d) * (d % 2 == 0 ? 1 : -1);
          ASSERT_NEAR(sum, expected, roundings * (p + 1) * epsilon * size)
              << "order " << d << " at " << u << ", y " << y;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllDegrees, Basis, ::testing::Range(1, max_degree + 1));

TEST(BasisValues, OneSpanIsBernsteinsBasisExactly) {
  for (int p = 1; p <= max_degree; ++p) {
    const KnotVector knots = testing::clamped_knots(p, {0, 1});
    double values[max_degree + 1], binomial = std::ldexp(1.0, -p);
    basis_values(knots, p, 0.5, values);
    for (int r = 0; r <= p; ++r) {
      EXPECT_EQ(values[r], binomial) << "degree " << p;
      binomial = binomial * (p - r) / (r + 1);
    }
  }
}

TEST(BasisValues, UniformCubicAtAKnotHasItsTextbookValues) {
  const KnotVector knots = testing::uniform_unclamped(3, 3);
  double got[4 * 4];
  basis_derivatives(knots, 4, 4, 3, got);
  const double expected[16] = {1.0 / 6, 4.0 / 6, 1.0 / 6, 0, -0.5, 0, 0.5, 0,
                               1,       -2,      1,       0, -1,   3, -3,  1};
  for (int k = 0; k < 16; ++k) EXPECT_NEAR(got[k], expected[k], 4 * epsilon) << k;
}

TEST(BasisValues, ClampedEndsInterpolateExactly) {
  for (int p = 1; p <= max_degree; ++p) {
    const KnotVector knots = testing::uniform_clamped(p, 4);
    double values[max_degree + 1];
    const auto [a, b] = knots.domain();
    basis_values(knots, knots.find_span(a), a, values);
    EXPECT_EQ(values[0], 1);
    for (int r = 1; r <= p; ++r) EXPECT_EQ(values[r], 0);
    basis_values(knots, knots.find_span(b), b, values);
    EXPECT_EQ(values[p], 1);
    for (int r = 0; r < p; ++r) EXPECT_EQ(values[r], 0);
  }
}

}  // namespace
}  // namespace knead
