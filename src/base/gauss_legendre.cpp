#include "knead/base/gauss_legendre.hpp"

#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

namespace knead {
namespace {

struct RuleTable {
  // Rule n occupies n entries from offset n (n - 1) / 2.
  std::vector<double> abscissae, weights;

  static std::size_t offset(int n) { return static_cast<std::size_t>(n) * static_cast<std::size_t>(n - 1) / 2; }

  RuleTable() : abscissae(offset(max_gauss_points + 1)), weights(abscissae.size()) {
    for (int n = 1; n <= max_gauss_points; ++n) {
      for (int k = 0; k < n; ++k) {
        // Tricomi's first guess for the k-th root from the left; the rule is symmetric, so roots are found in the right
        // half and mirrored exactly.
        const int mirrored = n - 1 - k;
        const bool left = k < mirrored;
        const int root = left ? mirrored : k;
        long double x = std::cos(std::numbers::pi_v<long double> * (static_cast<long double>(n - 1 - root) + 0.75L) /
                                 (static_cast<long double>(n) + 0.5L));
        if (k == mirrored) x = 0;
        long double derivative = 0;
        for (int iteration = 0; iteration < 100; ++iteration) {
          long double p0 = 1, p1 = x;
          for (int m = 2; m <= n; ++m) {
            const long double p2 = ((2 * m - 1) * x * p1 - (m - 1) * p0) / m;
            p0 = p1;
            p1 = p2;
          }
          derivative = n * (x * p1 - p0) / (x * x - 1);
          const long double step = p1 / derivative;
          if (k == mirrored) break;
          x -= step;
          if (std::abs(step) <= 1e-19L * (1 + std::abs(x))) break;
        }
        const std::size_t at = offset(n) + static_cast<std::size_t>(k);
        abscissae[at] = static_cast<double>(left ? -x : x);
        weights[at] = static_cast<double>(2 / ((1 - x * x) * derivative * derivative));
      }
    }
  }
};

}  // namespace

GaussRule gauss_legendre(int n) {
  assert(n >= 1 && n <= max_gauss_points);
  static const RuleTable table;
  const std::size_t at = RuleTable::offset(n), size = static_cast<std::size_t>(n);
  return {std::span(table.abscissae).subspan(at, size), std::span(table.weights).subspan(at, size)};
}

}  // namespace knead
