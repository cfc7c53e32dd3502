#include "lab_gramians.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "knead/spline/basis.hpp"

namespace knead::lab {
namespace {

struct Band {
  int n, p;
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(n) * static_cast<std::size_t>(2 * p + 1);
  }
  [[nodiscard]] std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(2 * p + 1) +
           static_cast<std::size_t>(j - i + p);
  }
  /// act(i, j, place) for all entries of the band.
  template <class Act>
  void each(Act act) const {
    for (int i = 0; i < n; ++i) {
      for (int j = std::max(0, i - p); j <= std::min(n - 1, i + p); ++j) act(i, j, at(i, j));
    }
  }
};

std::vector<double> absolute_integral(const KnotVector& knots, int a, int b) {
  const Band band{knots.count(), knots.degree()};
  std::vector<double> result(band.size());
  constexpr int most_pieces = 2048;
  const std::size_t spans = knots.spans().size();
  const std::vector<int> pieces(spans, std::clamp(most_pieces / static_cast<int>(spans), 2, 16));
  const BasisQuadrature rule = gauss_basis(knots, band.p + 1, std::max(a, b), pieces);
  for (int k = 0; k < rule.basis.size(); ++k) {
    const std::size_t g = static_cast<std::size_t>(k);
    const int first = rule.basis.first[g];
    const double *row = rule.basis.row(k, a), *column = rule.basis.row(k, b);
    for (int r = 0; r <= band.p; ++r) {
      for (int c = 0; c <= band.p; ++c) {
        result[band.at(first + r, first + c)] += rule.weights[g] * std::abs(row[r] * column[c]);
      }
    }
  }
  return result;
}

void subtract(Comparison& all, std::size_t pair) {
  const Band band{all.size, all.half_bandwidth};
  const auto [x, y] = compared_pairs[pair];
  const auto &first = all.values[static_cast<std::size_t>(x)],
             &second = all.values[static_cast<std::size_t>(y)];
  auto &difference = all.differences[pair], &relative = all.relative[pair];
  difference.assign(band.size(), 0.0);
  relative.assign(band.size(), 0.0);
  WorstEntry& worst = all.worst[pair];
  band.each([&](int i, int j, std::size_t at) {
    difference[at] = first[at] - second[at];
    const double size = std::abs(difference[at]);
    relative[at] = size == 0 ? 0 : size / all.absolute_integral[at];
    if (size > worst.absolute)
      worst.absolute = size, worst.absolute_row = i, worst.absolute_column = j;
    if (relative[at] > worst.relative) {
      worst.relative = relative[at], worst.relative_row = i, worst.relative_column = j;
    }
  });
}

}  // namespace

Expected<Comparison> compare_gramians(const KnotVector& knots, int a, int b) {
  const Band band{knots.count(), knots.degree()};
  Comparison all{band.n, band.p, {}, {}, {}, {}, {}, {}};
  for (std::size_t k = 0; k < compared_methods.size(); ++k) {
    const auto matrix = gramian(knots, a, b, compared_methods[k]);
    if (!matrix) return std::unexpected(matrix.error());
    all.used[k] = used_gramian_method(knots, a, b, compared_methods[k]);
    all.values[k].assign(band.size(), 0.0);
    band.each([&](int i, int j, std::size_t at) { all.values[k][at] = (*matrix)(i, j); });
  }
  all.absolute_integral = absolute_integral(knots, a, b);
  for (std::size_t pair = 0; pair < compared_pairs.size(); ++pair) subtract(all, pair);
  return all;
}

Expected<std::array<double, 3>> time_gramians(const KnotVector& knots, int a, int b,
                                              double budget) {
  using Clock = std::chrono::steady_clock;
  std::array<double, 3> seconds{};
  for (std::size_t k = 0; k < compared_methods.size(); ++k) {
    const auto start = Clock::now();
    const auto passed = [](Clock::time_point since) {
      return std::chrono::duration<double>(Clock::now() - since).count();
    };
    // Browser clocks tick only every 0.1 ms: batches are doubled until they take longer than that.
    constexpr double readable = 0.4e-3;
    double quickest = std::numeric_limits<double>::infinity();
    for (int runs = 1;
         quickest == std::numeric_limits<double>::infinity() || passed(start) < budget;) {
      const auto begin = Clock::now();
      for (int run = 0; run < runs; ++run) {
        const auto matrix = gramian(knots, a, b, compared_methods[k]);
        if (!matrix) return std::unexpected(matrix.error());
      }
      const double batch = passed(begin);
      if (batch < readable && runs < 1 << 20) {
        runs *= 2;
      } else {
        quickest = std::min(quickest, batch / runs);
      }
    }
    seconds[k] = quickest;
  }
  return seconds;
}

}  // namespace knead::lab
