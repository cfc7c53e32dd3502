#include "spline/interpolation/chebyshev_interpolation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "spline/interpolation/greville_interpolation.hpp"
#include "support/knot_families.hpp"
#include "support/long_run.hpp"

namespace knead {
namespace {

/// max Σ_i |ℓ_i(u)| over the domain, ℓ_i the cardinal splines: how much larger than its values a
/// spline can be.
double norm_of(const KnotVector& knots, const SiteInterpolation& at) {
  const int p = knots.degree(), samples = 2 * p + 3;
  const auto n = static_cast<std::size_t>(knots.count());
  std::vector<double> cardinal(n * n, 0.0), basis(static_cast<std::size_t>(p + 1));
  for (std::size_t i = 0; i < n; ++i) cardinal[i * n + i] = 1;
  at.solve(cardinal.data(), 1, n);
  double largest = 0;
  for (const int span : knots.spans()) {
    const double a = knots[span], b = knots[span + 1];
    for (int k = 0; k <= samples; ++k) {
      basis_values(knots, span,
                   std::min(b, a + (b - a) * 0.5 * (1 - std::cos(std::numbers::pi * k / samples))),
                   basis.data());
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i) {
        double value = 0;
        for (int r = 0; r <= p; ++r) {
          value += basis[static_cast<std::size_t>(r)] *
                   cardinal[static_cast<std::size_t>(span - p + r) * n + i];
        }
        sum += std::abs(value);
      }
      largest = std::max(largest, sum);
    }
  }
  return largest;
}

/// Spans of 1 to 10^decades, knots of multiplicity 1 to most.
KnotVector uneven_knots(int p, int spans, double decades, int most, std::mt19937_64& random) {
  std::vector<double> lengths;
  std::vector<int> multiplicity = {0};
  for (int k = 0; k < spans; ++k) {
    lengths.push_back(std::pow(10, std::uniform_real_distribution<double>(0, decades)(random)));
    multiplicity.push_back(std::uniform_int_distribution<int>(1, most)(random));
  }
  return testing::clamped_knots(p, testing::breaks_of(lengths), multiplicity);
}

TEST(ChebyshevInterpolation, HasTheSitesOfTheChebyshevPolynomialOnABezierPiece) {
  for (const int p : testing::checked_degrees) {
    const std::vector<double> sites = chebyshev_sites(testing::clamped_knots(p, {-1, 1}));
    ASSERT_EQ(sites.size(), static_cast<std::size_t>(p + 1));
    for (int i = 0; i <= p;
         ++i) {  // the exchange ends where extrema are equal to 1e-3: their places are to its root
      EXPECT_NEAR(sites[static_cast<std::size_t>(i)], -std::cos(std::numbers::pi * i / p), 0.04)
          << p << " " << i;
    }
  }
}

TEST(ChebyshevInterpolation, HasTheKnotsAsSitesOfDegreeOne) {
  for (const auto& [name, knots] : testing::knot_families(1)) {
    EXPECT_EQ(chebyshev_sites(knots), greville_sites(knots)) << name;
  }
}

TEST(ChebyshevInterpolation, IsStableAtEveryDegreeAndMultiplicityOverSpansOfAnyLengths) {
  std::mt19937_64 random(11);
  const int times = testing::long_run() ? 100 : 2;
  for (const int p : {1, 2, 3, 4, 5, 7, 10, 15, 20, 22, 25}) {
    // Grows like that of the Chebyshev polynomials, which is below (2/π) ln p + 1
    const double most = 1.05 * (2 / std::numbers::pi * std::log(p) + 1);
    const auto check = [&](const KnotVector& knots, const std::string& name) {
      const auto made = ChebyshevInterpolation::create(knots);
      ASSERT_TRUE(made) << name << ": " << made.error().message();
      EXPECT_LE(norm_of(knots, *made), most) << name;
    };
    for (const int m : {1, (p + 1) / 2, std::max(1, p - 1), p, p + 1}) {
      check(testing::clamped_knots(p, {0, 1, 2, 3, 4}, {0, m, m, m, 0}),
            fmt::format("p={} m={}", p, m));
    }
    for (int k = 0; k < times; ++k) {
      check(uneven_knots(p, 6, 6, p + 1, random), fmt::format("p={} uneven {}", p, k));
      check(uneven_knots(p, 10, 6, 1, random), fmt::format("p={} uneven and smooth {}", p, k));
    }
  }
}

TEST(ChebyshevInterpolation, GrevilleAbscissaeAreNot) {
  const KnotVector piece = testing::clamped_knots(22, {0, 1});
  EXPECT_GT(norm_of(piece, *GrevilleInterpolation::create(piece)), 1e4);
  EXPECT_LT(norm_of(piece, *ChebyshevInterpolation::create(piece)), 3);
}

TEST(ChebyshevInterpolation, GivesSplinesBackOnEveryKindOfKnots) {
  for (const int p : {1, 2, 3, 5, 8}) {
    for (const auto& [name, knots] : testing::knot_families(p)) {
      const auto made = ChebyshevInterpolation::create(knots);
      ASSERT_TRUE(made) << name << ": " << made.error().message();
      const auto n = static_cast<std::size_t>(knots.count());
      std::mt19937_64 random(5);
      std::vector<double> values(n);
      for (double& x : values) x = std::uniform_real_distribution<double>(-1, 1)(random);
      std::vector<double> c = values;
      made->solve(c.data(), 1, 1);
      for (std::size_t i = 0; i < n; ++i) {
        if (knots[static_cast<int>(i) + p + 1] <= knots.domain().lower ||
            knots[static_cast<int>(i)] >= knots.domain().upper) {
          EXPECT_EQ(c[i], 0) << name;  // it vanishes on the domain
          continue;
        }
        EXPECT_TRUE(knots.domain().contains(made->abscissae()[i])) << name;
        double value = 0;
        for (int r = 0; r <= p; ++r) {
          value += made->basis().row(static_cast<int>(i), 0)[r] *
                   c[static_cast<std::size_t>(made->basis().first[i] + r)];
        }
        // Elimination is backward stable; coefficients of unclamped bases and of clusters are
        // large.
        EXPECT_NEAR(value, values[i], 1e-9) << name << " " << i;
      }
    }
  }
}

TEST(ChebyshevInterpolation, SitesOfMirroredKnotsAreMirrored) {
  std::mt19937_64 random(3);
  for (const int p : {2, 3, 5, 9}) {
    const KnotVector knots = uneven_knots(p, 7, 2, p, random);
    const double end = knots.domain().upper;
    std::vector<double> turned;
    for (int i = static_cast<int>(knots.knots().size()); i-- > 0;) turned.push_back(end - knots[i]);
    const std::vector<double> there = chebyshev_sites(knots),
                              back = chebyshev_sites(testing::make_knots(p, turned));
    for (std::size_t i = 0; i < there.size(); ++i) {
      EXPECT_NEAR(there[i], end - back[there.size() - 1 - i], 1e-9 * end) << p << " " << i;
    }
  }
}

}  // namespace
}  // namespace knead
