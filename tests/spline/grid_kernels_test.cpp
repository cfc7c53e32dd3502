#include "spline/simd/grid_kernels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include "sample_splines.hpp"
#include "spline/evaluate_grid_by.hpp"

namespace knead {
namespace {

using detail::GridKernels;

constexpr double untouched = 0x1.8p300;

bool same_numbers(std::span<const double> a, std::span<const double> b) {
  return std::ranges::equal(a, b, {}, std::bit_cast<std::uint64_t, double>,
                            std::bit_cast<std::uint64_t, double>);
}

std::vector<double> random_numbers(std::mt19937_64& random, std::ptrdiff_t count,
                                   double lower = -1) {
  std::vector<double> result(static_cast<std::size_t>(count));
  for (double& x : result) x = std::uniform_real_distribution<double>(lower, 1)(random);
  return result;
}

/// Calls check(kernels) with those of every set that this machine has beside the reference, two
/// numbers wide.
void with_every_set(const std::function<void(const GridKernels&)>& check) {
  for (const InstructionSet set : available_instruction_sets()) {
    SCOPED_TRACE(name(set));
    check(detail::grid_kernels(set));
  }
}

/// Runs of one to nine points.
std::vector<detail::SpanRun> random_runs(std::mt19937_64& random, std::ptrdiff_t size) {
  std::vector<detail::SpanRun> runs;
  for (std::ptrdiff_t k = 0; k < size;) {
    const auto end =
        std::min(size, k + std::uniform_int_distribution<std::ptrdiff_t>(1, 9)(random));
    runs.push_back({std::ssize(runs), k, end});
    k = end;
  }
  return runs;
}

TEST(GridKernels, ContractWithTheSameBits) {
  std::mt19937_64 random(71);
  for (std::ptrdiff_t terms = 1; terms <= 8; ++terms) {
    for (std::ptrdiff_t length = 1; length <= 35; ++length) {
      const auto values = random_numbers(random, terms),
                 from = random_numbers(random, terms * length);
      std::vector<double> expected;
      for (std::ptrdiff_t c = 0; c < length; ++c) {
        double sum = values[0] * from[static_cast<std::size_t>(c)];
        for (std::ptrdiff_t r = 1; r < terms; ++r)
          sum +=
              values[static_cast<std::size_t>(r)] * from[static_cast<std::size_t>(r * length + c)];
        expected.push_back(sum);
      }
      expected.push_back(untouched);
      with_every_set([&](const GridKernels& kernels) {
        std::vector<double> found(static_cast<std::size_t>(length + 1), untouched);
        kernels.contract(values.data(), terms, from.data(), length, found.data());
        EXPECT_TRUE(same_numbers(found, expected));
      });
    }
  }
}

TEST(GridKernels, SumRowsWithTheSameBitsAndWriteNothingBeyond) {
  std::mt19937_64 random(72);
  for (std::ptrdiff_t terms = 1; terms <= 8; ++terms) {
    for (std::ptrdiff_t size = 1; size <= 35; ++size) {
      const auto runs = random_runs(random, size);
      const std::ptrdiff_t stride = size + GridKernels::spare, points = terms + std::ssize(runs);
      const detail::GridRow row{runs.data(), std::ssize(runs), size, stride, terms};
      const auto values = random_numbers(random, terms * stride),
                 line = random_numbers(random, 4 * points);
      std::vector<double> cartesian, homogeneous;
      for (const detail::SpanRun& run : runs) {
        for (std::ptrdiff_t k = run.begin; k < run.end; ++k) {
          for (const std::ptrdiff_t width : {3, 4}) {
            for (std::ptrdiff_t c = 0; c < width; ++c) {
              const double* at = line.data() + width * run.first + c;
              double sum = values[static_cast<std::size_t>(k)] * at[0];
              for (std::ptrdiff_t r = 1; r < terms; ++r)
                sum += values[static_cast<std::size_t>(r * stride + k)] * at[width * r];
              (width == 3 ? cartesian : homogeneous).push_back(sum);
            }
          }
        }
      }
      cartesian.push_back(untouched);
      with_every_set([&](const GridKernels& kernels) {
        std::vector<double> found(cartesian.size(), untouched);
        kernels.points(row, values.data(), line.data(), found.data());
        EXPECT_TRUE(same_numbers(found, cartesian));
        std::vector<double> apart(static_cast<std::size_t>(4 * stride + GridKernels::spare));
        kernels.homogeneous(row, values.data(), line.data(), apart.data());
        for (std::ptrdiff_t k = 0; k < 4 * size; ++k) {
          EXPECT_EQ(apart[static_cast<std::size_t>(k % 4 * stride + k / 4)],
                    homogeneous[static_cast<std::size_t>(k)]);
        }
      });
    }
  }
}

TEST(GridKernels, FindTheFirstDenominatorThatIsNotPositive) {
  std::mt19937_64 random(73);
  const std::size_t begin[] = {0, 0};
  const detail::QuotientTerms rule{nullptr, begin, 1};
  for (std::ptrdiff_t size = 1; size <= 19; ++size) {
    const std::ptrdiff_t stride = size + GridKernels::spare;
    for (std::ptrdiff_t bad = 0; bad <= size; ++bad) {
      for (const double value : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        auto from = random_numbers(random, 4 * stride + GridKernels::spare, 0.5);
        for (std::ptrdiff_t k = bad; k < stride; ++k)
          from[static_cast<std::size_t>(3 * stride + k)] = value;
        with_every_set([&](const GridKernels& kernels) {
          std::vector<double> work(3 * GridKernels::spare),
              to(static_cast<std::size_t>(3 * size + 4), untouched);
          double* const out[] = {to.data()};
          EXPECT_EQ(kernels.divide(rule, from.data(), stride, size, work.data(), out, 1), bad);
          for (std::ptrdiff_t i = 0; bad == size && i < 3 * size; ++i) {
            EXPECT_EQ(to[static_cast<std::size_t>(3 + i)],
                      from[static_cast<std::size_t>(i % 3 * stride + i / 3)] /
                          from[static_cast<std::size_t>(3 * stride + i / 3)]);
          }
          EXPECT_EQ(to[2], untouched);
          EXPECT_EQ(to.back(), untouched);
        });
      }
    }
  }
}

TEST(GridKernels, GiveNormalsWithTheSameBits) {
  std::mt19937_64 random(74);
  for (std::ptrdiff_t count = 1; count <= 35; ++count) {
    auto u = random_numbers(random, 3 * count), v = random_numbers(random, 3 * count);
    for (std::size_t k = 0; k < u.size(); k += 3) {
      const auto kind = random() % 5;  // parallel, zero, nearly parallel, and twice any
      for (std::size_t c = k; kind < 3 && c < k + 3; ++c)
        v[c] = kind == 0 ? -2 * u[c] : kind == 1 ? 0 : u[c];
      if (kind == 2) v[k] += 1e-9;
    }
    std::vector<double> expected;
    for (std::size_t k = 0; k < u.size(); k += 3) {
      const double *a = u.data() + k, *b = v.data() + k;
      const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2],
                   z = a[0] * b[1] - a[1] * b[0];
      const double length = std::sqrt(x * x + y * y + z * z);
      const double speeds =
          a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
      const double factor = length > 1e-9 * speeds ? 1 / length : 0;
      expected.insert(expected.end(), {factor * x, factor * y, factor * z});
    }
    expected.push_back(untouched);
    with_every_set([&](const GridKernels& kernels) {
      std::vector<double> found(expected.size(), untouched);
      kernels.normals(u.data(), v.data(), count, found.data());
      EXPECT_TRUE(same_numbers(found, expected));
    });
  }
}

/// `count` parameters of the domain, knots among them, rising.
std::vector<double> some_parameters(std::mt19937_64& random, const KnotVector& knots, int count) {
  const auto [lower, upper] = knots.domain();
  const std::vector<int> spans = knots.spans();
  std::vector<double> result;
  for (int k = 0; k < count; ++k) {
    const double t = std::uniform_real_distribution<double>(0, 1)(random);
    result.push_back(random() % 3 == 0 ? knots[spans[random() % spans.size()]]
                                       : std::clamp(lower + t * (upper - lower), lower, upper));
  }
  std::ranges::sort(result);
  return result;
}

/// Every set's grid has the bits of `evaluate` at its points.
template <int D>
void expect_points_by_every_set(std::mt19937_64& random, const Spline<D>& spline,
                                std::array<int, D> counts, int order) {
  std::array<std::vector<double>, D> grid;
  std::array<BasisTable, D> tables;
  std::array<const BasisTable*, D> pointers;
  for (std::size_t d = 0; d < D; ++d) {
    grid[d] = some_parameters(random, spline.knots()[d], counts[d]);
    tables[d] = *tabulate_basis(spline.knots()[d], grid[d], order);
    pointers[d] = &tables[d];
  }
  const auto expected = evaluate<D>(spline, testing::rows_of<D>(grid), order);
  ASSERT_TRUE(expected) << expected.error().message();
  with_every_set([&](const GridKernels& kernels) {
    Evaluation<D> found;
    ASSERT_TRUE(detail::evaluate_grid_by<D>(kernels, spline, pointers, order, found));
    ASSERT_EQ(found.derivatives.size(), expected->derivatives.size());
    for (std::size_t k = 0; k < found.derivatives.size(); ++k) {
      const Points &a = found.derivatives[k], &b = expected->derivatives[k];
      ASSERT_EQ(a.rows(), b.rows());
      EXPECT_TRUE(same_numbers({a.data(), static_cast<std::size_t>(a.size())},
                               {b.data(), static_cast<std::size_t>(b.size())}))
          << "derivative " << k;
    }
  });
}

class GridsOfDegree : public ::testing::TestWithParam<int> {};

TEST_P(GridsOfDegree, HaveTheSameBitsByEveryInstructionSet) {
  const int p = GetParam();
  std::mt19937_64 random(static_cast<std::uint64_t>(80 + p));
  int count = 0;
  for (const auto& [name, knots] : testing::knot_families(p)) {
    SCOPED_TRACE(name);
    count = count % 17 + 1;
    const auto across = testing::random_knots(random, static_cast<int>(random() % 4) + 1);
    for (const double decades : {-1.0, 2.0}) {
      expect_points_by_every_set<1>(random, testing::random_spline<1>(random, {knots}, decades),
                                    {count}, 2);
      expect_points_by_every_set<2>(
          random, testing::random_spline<2>(random, {across, knots}, decades), {3, count}, 2);
      expect_points_by_every_set<2>(random,
                                    testing::random_spline<2>(random, {knots, across}, decades),
                                    {count, 18 - count}, 1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, GridsOfDegree, ::testing::Range(1, 8));

TEST(GridKernels, EvaluateVolumesWithTheSameBits) {
  std::mt19937_64 random(91);
  for (int count = 1; count <= 17; ++count) {
    const auto u = testing::random_knots(random, 2), v = testing::random_knots(random, 1);
    const auto w = testing::random_knots(random, static_cast<int>(random() % 5) + 1);
    for (const double decades : {-1.0, 1.0}) {
      expect_points_by_every_set<3>(random, testing::random_spline<3>(random, {u, v, w}, decades),
                                    {2, 3, count}, 2);
    }
  }
}

}  // namespace
}  // namespace knead
