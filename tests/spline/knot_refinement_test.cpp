#include "knead/spline/spline_refinement.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/knot_families.hpp"
#include "support/quad_gramian.hpp"

namespace knead {
namespace {

using testing::clamped_knots;
using testing::knot_families;
using testing::periodic;
using testing::Quad;
using testing::quad_span_basis;
using testing::uniform_unclamped;

Refinement make(const KnotVector& from, const Expected<KnotVector>& to) {
  if (!to) ADD_FAILURE() << to.error().message();
  auto made = Refinement::create(from, *to);
  if (!made) ADD_FAILURE() << made.error().message();
  return *std::move(made);
}

/// Knots to insert: midpoints, places right beside knots, repeated knots up to multiplicity p + 1.
std::vector<double> random_inserted(std::mt19937_64& random, const KnotVector& knots) {
  std::vector<double> inserted;
  const auto coin = [&] { return std::uniform_int_distribution<int>(0, 2)(random) == 0; };
  const auto [a, b] = knots.domain();
  for (const int s : knots.spans()) {
    const double length = knots[s + 1] - knots[s];
    for (const double t : {0.5, 1e-9, 0.3}) {
      const double u = knots[s] + t * length;
      if (coin() && knots[s] < u && u < knots[s + 1])
        inserted.insert(inserted.end(), coin() ? 1 : 2, u);
    }
    const double u = knots[s];
    const int room = knots.degree() + 1 - knots.multiplicity(u);
    if (a < u && u < b && room > 0 && coin()) {
      inserted.insert(inserted.end(), std::uniform_int_distribution<std::size_t>(1, room)(random),
                      u);
    }
  }
  if (knots.degree() == 1) {  // two of the same are the limit
    std::ranges::sort(inserted);
    inserted.erase(std::ranges::unique(inserted).begin(), inserted.end());
  }
  std::ranges::shuffle(inserted, random);
  return inserted;
}

/// max over places and coarse functions of |N_j − Σ_i R_ij Ñ_i|, all but R in quadruple precision.
Quad identity_error(const Refinement& r) {
  const KnotVector &x = r.from(), &y = r.to();
  const int p = x.degree(), q = y.degree();
  Quad worst = 0;
  for (const int s : y.spans()) {
    for (const Quad t : {Quad(0), Quad(0.375), Quad(1)}) {
      const Quad u = Quad(y[s]) + t * (Quad(y[s + 1]) - Quad(y[s]));
      const int span = x.find_span(y[s]);
      const auto coarse = quad_span_basis(x, p, 0, span, u), fine = quad_span_basis(y, q, 0, s, u);
      std::vector<Quad> sum(static_cast<std::size_t>(x.count()), Quad(0));
      for (int i = s - q; i <= s; ++i) {
        for (int k = 0; k <= p; ++k) {
          sum[static_cast<std::size_t>(r.first(i) + k)] +=
              fine[static_cast<std::size_t>(i - s + q)] *
              Quad(r.row(i)[static_cast<std::size_t>(k)]);
        }
      }
      for (int k = 0; k <= p; ++k)
        sum[static_cast<std::size_t>(span - p + k)] -= coarse[static_cast<std::size_t>(k)];
      for (const Quad value : sum) worst = std::max(worst, testing::magnitude(value));
    }
  }
  return worst;
}

/// The insertion matrix from x to x with `inserted`, in quadruple precision, one knot at a time
/// (Boehm): only positive numbers are added. Row by row over all columns; `x` ends as the knots
/// with all of them, which must lie among the inner ones.
std::vector<std::vector<Quad>> quad_insertion(std::vector<double>& x, int p,
                                              const std::vector<double>& inserted) {
  const auto columns = x.size() - static_cast<std::size_t>(p) - 1;
  std::vector<std::vector<Quad>> rows(columns, std::vector<Quad>(columns, Quad(0)));
  for (std::size_t i = 0; i < columns; ++i) rows[i][i] = 1;
  for (const double u : inserted) {
    const auto after = std::ranges::upper_bound(x, u);
    const auto span = static_cast<std::size_t>(after - x.begin()) - 1,
               degree = static_cast<std::size_t>(p);
    auto next = rows;
    next.insert(next.begin() + static_cast<std::ptrdiff_t>(span - degree), rows[span - degree]);
    for (std::size_t i = span - degree + 1; i <= span; ++i) {
      next[i] = rows[i - 1];
      if (x[i] == u) continue;
      const Quad a = x[i], b = x[i + degree];
      for (std::size_t j = 0; j < columns; ++j) {
        next[i][j] = ((u - a) * rows[i][j] + (b - u) * rows[i - 1][j]) / (b - a);
      }
    }
    rows = std::move(next);
    x.insert(after, u);
  }
  return rows;
}

/// What stands in `more` and not in `knots`, with multiplicities.
std::vector<double> missing(std::span<const double> knots, std::span<const double> more) {
  std::vector<double> result;
  std::ranges::set_difference(more, knots, std::back_inserter(result));
  return result;
}

/// Row i of the refinement, in quadruple precision.
std::vector<Quad> quad_row(const Refinement& r, int i) {
  const int p = r.from().degree(), q = r.to().degree();
  const std::vector<double> y(r.to().knots().begin(), r.to().knots().end());
  std::vector<Quad> sum(static_cast<std::size_t>(r.from().count()), Quad(0));
  for (int left_out = 1; left_out <= (p == q ? 1 : q); ++left_out) {
    // The polar form at y_{i+1} … without the one left out is a coefficient over knots that hold
    // these in a row: all coarse knots, and of the fine ones those from y_i on to y_{i+q+1}.
    std::vector<double> window(y.begin() + i, y.begin() + i + q + 2);
    if (p < q) window.erase(window.begin() + left_out);
    // Further knots at both ends, so that there are functions wherever a knot is inserted; their
    // columns do not count.
    std::vector<double> x(r.from().knots().begin(), r.from().knots().end());
    const double far = 1 + x.back() - x.front();
    x.insert(x.begin(), static_cast<std::size_t>(p + 1), x.front() - far);
    x.insert(x.end(), static_cast<std::size_t>(p + 1), x.back() + far);
    const auto rows = quad_insertion(x, p, missing(x, window));
    // Knots of the coarse vector all stand in the fine one, so the window is a run of x.
    const auto found = std::ranges::search(x, window);
    if (found.empty()) {
      ADD_FAILURE() << "row " << i << " is no run of knots";
      return sum;
    }
    const auto& row = rows[static_cast<std::size_t>(found.begin() - x.begin())];
    for (std::size_t j = 0; j < sum.size(); ++j)
      sum[j] += row[j + static_cast<std::size_t>(p + 1)] / (p == q ? 1 : q);
  }
  return sum;
}

/// Every entry non-negative and right to 4 (p + 1) ulp; zero exactly where it should be.
void expect_exact_entries(const Refinement& r, const std::string& name) {
  const int p = r.from().degree();
  for (int i = 0; i < r.to().count(); ++i) {
    double sum = 0;
    const auto reference = quad_row(r, i);
    for (int k = 0; k <= p; ++k) {
      const double value = r.row(i)[static_cast<std::size_t>(k)];
      sum += value;
      ASSERT_GE(value, 0) << name << " row " << i;
      ASSERT_FALSE(std::signbit(value)) << name << " row " << i;
      const Quad exact = reference[static_cast<std::size_t>(r.first(i) + k)];
      ASSERT_LE(static_cast<double>(testing::magnitude(value - exact)),
                4 * (p + 1) * 0x1p-52 * static_cast<double>(exact))
          << name << " row " << i << " column " << r.first(i) + k;
    }
    ASSERT_NEAR(sum, 1, 4 * (p + 1) * 0x1p-52) << name << " row " << i;
    if (r.copied(i) >= 0) {
      ASSERT_EQ(r.row(i)[static_cast<std::size_t>(r.copied(i) - r.first(i))], 1.0);
    }
  }
}

constexpr int degrees[] = {1, 2, 3, 4, 5, 8, 14};

TEST(Refinement, InsertionIsExactInEveryEntryOnEveryFamily) {
  std::mt19937_64 random(11);
  for (const int p : degrees) {
    for (const auto& [name, knots] : knot_families(p)) {
      const auto r = make(knots, with_knots(knots, random_inserted(random, knots)));
      expect_exact_entries(r, name);
      EXPECT_LE(static_cast<double>(identity_error(r)), 4 * (p + 1) * 0x1p-52) << name;
    }
  }
}

TEST(Refinement, ElevationIsExactInEveryEntryOnEveryFamily) {
  for (const int p : degrees) {
    for (const auto& [name, knots] : knot_families(p)) {
      const auto r = make(knots, elevated_knots(knots));
      EXPECT_EQ(r.to().degree(), p + 1);
      EXPECT_EQ(r.to().domain().lower, knots.domain().lower);
      EXPECT_EQ(r.to().domain().upper, knots.domain().upper);
      EXPECT_EQ(r.to().clamped_start(), knots.multiplicity(knots.domain().lower) == p + 1) << name;
      for (const double u : knots.knots()) {
        if (knots.domain().lower < u && u < knots.domain().upper) {
          EXPECT_EQ(r.to().multiplicity(u), knots.multiplicity(u) + 1) << name;
        }
      }
      expect_exact_entries(r, name);
      EXPECT_LE(static_cast<double>(identity_error(r)), 4 * (p + 1) * 0x1p-52) << name;
    }
  }
}

TEST(Refinement, RandomKnotsStayExact) {
  for (std::uint64_t seed = 1; seed <= 600; ++seed) {
    std::mt19937_64 random(seed);
    const int p = std::uniform_int_distribution<int>(1, 8)(random);
    const auto knots = testing::random_knots(random, p);
    const auto name = "seed " + std::to_string(seed);
    const auto inserted = make(knots, with_knots(knots, random_inserted(random, knots)));
    expect_exact_entries(inserted, name + " inserted");
    expect_exact_entries(make(knots, elevated_knots(knots)), name + " elevated");
  }
}

TEST(Refinement, OnlyRowsWhoseSupportIsTouchedAreNotCopies) {
  for (const int p : degrees) {
    for (const auto& [name, knots] : knot_families(p)) {
      const auto spans = knots.spans();
      const int s = spans[spans.size() / 2];
      const double u = std::midpoint(knots[s], knots[s + 1]);
      if (!(knots[s] < u && u < knots[s + 1])) continue;
      const double list[] = {u};
      const auto r = make(knots, with_knots(knots, list));
      for (int i = 0; i < r.to().count(); ++i) {
        const bool touched = r.to()[i + 1] <= u && u <= r.to()[i + p];
        EXPECT_EQ(r.copied(i) < 0, touched) << name << " row " << i;
        if (!touched) {
          EXPECT_EQ(r.copied(i), r.to()[i + p] < u ? i : i - 1) << name;
        }
      }
    }
  }
}

TEST(Refinement, BezierKnotsCutEveryFamilyIntoPieces) {
  for (const int p : degrees) {
    for (const auto& [name, knots] : knot_families(p)) {
      const auto r = make(knots, bezier_knots(knots));
      EXPECT_EQ(r.to().count(), (p + 1) * static_cast<int>(knots.spans().size())) << name;
      if (knots.clamped()) expect_exact_entries(r, name);
      double largest = 1;
      for (int i = 0; i < r.to().count(); ++i) {
        for (const double value : r.row(i)) largest = std::max(largest, std::abs(value));
      }
      EXPECT_LE(static_cast<double>(identity_error(r)), 4 * (p + 1) * 0x1p-52 * largest) << name;
    }
  }
}

TEST(Refinement, PeriodicKnotsStayPeriodic) {
  for (const int p : {1, 2, 3, 5}) {
    const auto knots = periodic(p, {1, 0.5, 2, 0.25, 3});
    const auto [a, b] = knots.domain();
    const double list[] = {a + 0.125, a + 0.75, a + 1.25, b - 0.5, b - 0.5 * (p > 1)};
    const auto r = make(knots, with_periodic_knots(knots, std::span(list, p > 1 ? 5 : 4)));
    const int period = r.to().count() - p;
    EXPECT_EQ(period, 5 + (p > 1 ? 5 : 4));
    for (int i = 0; i < static_cast<int>(r.to().knots().size()) - period; ++i) {
      EXPECT_EQ(r.to()[i + period] - r.to()[i], b - a) << i;  // exact in these binary fractions
    }
    expect_exact_entries(r, "periodic");
    EXPECT_LE(static_cast<double>(identity_error(r)), 4 * (p + 1) * 0x1p-52);
    // Periodic coefficients stay periodic.
    std::vector<double> c(static_cast<std::size_t>(knots.count())),
        fine(static_cast<std::size_t>(r.to().count()));
    for (std::size_t j = 0; j < c.size(); ++j) c[j] = std::sin(1 + static_cast<double>(j % 5));
    r.apply(c.data(), fine.data(), 1, 1);
    for (std::size_t i = 0; i < static_cast<std::size_t>(p); ++i) {
      EXPECT_NEAR(fine[i], fine[i + static_cast<std::size_t>(period)], 4 * (p + 1) * 0x1p-52);
    }
  }
}

TEST(Refinement, MatrixAndApplyAreTheSameMap) {
  std::mt19937_64 random(5);
  const auto knots = clamped_knots(3, {0, 1, 2.5, 3, 4.5, 5}, {0, 1, 1, 3, 1, 0});
  const auto r = make(knots, elevated_knots(knots));
  Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor> c(knots.count(), 4),
      fine(r.to().count(), 4);
  c.setRandom();
  r.apply(c.data(), fine.data(), 1, 4);
  EXPECT_LE((r.matrix() * c - fine).cwiseAbs().maxCoeff(), 1e-15);
  // Two nets one behind the other.
  std::vector<double> two(2 * static_cast<std::size_t>(c.size())),
      out(2 * static_cast<std::size_t>(fine.size()));
  std::copy_n(c.data(), c.size(), two.begin());
  std::copy_n(c.data(), c.size(), two.begin() + c.size());
  r.apply(two.data(), out.data(), 2, 4);
  EXPECT_TRUE(std::equal(fine.data(), fine.data() + fine.size(), out.begin()));
  EXPECT_TRUE(std::equal(fine.data(), fine.data() + fine.size(), out.begin() + fine.size()));
}

TEST(Refinement, EndsOfAnUnclampedDomainMayBeRepeated) {
  for (const int p : {1, 2, 3, 5}) {
    for (const auto& knots : {uniform_unclamped(p, 4), periodic(p, {1, 0.5, 2, 0.25, 3})}) {
      const auto [a, b] = knots.domain();
      for (int times = 1; times <= p; ++times) {
        std::vector<double> list(static_cast<std::size_t>(times), a);
        list.insert(list.end(), list.size(), b);
        list.push_back((a + 2 * b) / 3);
        const auto r = make(knots, with_knots(knots, list));
        EXPECT_EQ(r.to().domain().lower, a);
        EXPECT_EQ(r.to().domain().upper, b);
        EXPECT_LE(static_cast<double>(identity_error(r)), 4 * (p + 1) * 0x1p-52);
        expect_exact_entries(r,
                             "p = " + std::to_string(p) + ", " + std::to_string(times) + " times");
      }
    }
  }
}

TEST(Refinement, WhatCannotBeInsertedIsNamed) {
  const auto knots = clamped_knots(2, {0, 1, 2}, {0, 2, 0});
  const auto message = [&](std::vector<double> list) {
    const auto result = with_knots(knots, list);
    EXPECT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::input);
    return result.error().message();
  };
  EXPECT_NE(message({0.5, std::nan("")}).find("inserted knot 1"), std::string::npos);
  EXPECT_NE(message({2.5}).find("outside of the domain"), std::string::npos);
  EXPECT_NE(message({-1e-300}).find("outside of the domain"), std::string::npos);
  EXPECT_NE(
      message({1, 0.5, 1}).find("inserted knot 2: the knot 1 would be repeated more than 3 times"),
      std::string::npos);
  EXPECT_NE(message({2}).find("would be repeated"), std::string::npos)
      << "the last knot of a clamped vector";
  EXPECT_NE(message({0}).find("would be repeated"), std::string::npos);
  EXPECT_TRUE(with_knots(knots, std::vector<double>{}));

  EXPECT_FALSE(with_periodic_knots(knots, std::vector{0.5})) << "clamped";
  const auto turning = periodic(2, {1, 2, 1});
  EXPECT_FALSE(with_periodic_knots(turning, std::vector{turning.domain().lower}));
  EXPECT_FALSE(elevated_knots(clamped_knots(max_degree, {0, 1})));

  EXPECT_FALSE(Refinement::create(knots, clamped_knots(2, {0, 1, 2}))) << "a knot is missing";
  EXPECT_FALSE(Refinement::create(knots, clamped_knots(2, {0, 1, 3}, {0, 2, 0})))
      << "another domain";
  EXPECT_FALSE(Refinement::create(knots, clamped_knots(4, {0, 1, 2}, {0, 4, 0})))
      << "two degrees at once";
}

TEST(SpanMidpoints, AreTakenWhereTheIntervalMeetsTheInside) {
  const auto knots = clamped_knots(2, {0, 1, 2, 4});
  EXPECT_EQ(span_midpoints(knots, {1, 2}), (std::vector{1.5}));
  EXPECT_EQ(span_midpoints(knots, {1, 2.1}), (std::vector{1.5, 3.0}));
  EXPECT_EQ(span_midpoints(knots, {1, 1}), (std::vector{0.5, 1.5}));
  EXPECT_EQ(span_midpoints(knots, {-5, 9}), (std::vector{0.5, 1.5, 3.0}));
  EXPECT_EQ(span_midpoints(knots, {4, 4}), (std::vector{3.0}));
  EXPECT_TRUE(span_midpoints(clamped_knots(1, {1, std::nextafter(1, 2)}), {1, 2}).empty());
}

}  // namespace
}  // namespace knead
