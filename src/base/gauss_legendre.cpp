#include "gauss_legendre.hpp"

#include <cassert>
#include <cfloat>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace knead {
namespace {

// 113 bits: near the ends a weight is about 1 / (1 − x²) times more sensitive than its abscissa, so
// 80-bit numbers lose the last bit of the weights above 60 points.
#if LDBL_MANT_DIG >= 113
using Wide = long double;
#else
__extension__ typedef __float128
    Wide;  // NOLINT(modernize-use-using): __extension__ takes a typedef only
#endif

// Bonnet's recursion m P_m = (2m − 1) x P_{m−1} − (m − 1) P_{m−2}, stable for |x| ≤ 1, and P_n'
// from P_n and P_{n−1}. O(n) a point.
template <class Real>
void legendre(int n, Real x, Real& value, Real& derivative) {
  Real p0 = 1, p1 = x;
  for (int m = 2; m <= n; ++m) {
    const Real p2 = ((2 * m - 1) * x * p1 - (m - 1) * p0) / m;
    p0 = p1;
    p1 = p2;
  }
  value = p1;
  derivative = n * (x * p1 - p0) / (x * x - 1);
}

struct Node {
  double abscissa, weight;
};

/// The k-th root of P_n from the left and its weight 2 / ((1 − x²) P_n'(x)²), for the right half of
/// the roots.
Node node(int n, int k) {
  // Tricomi's initial guess, Newton's iteration in double, and one more step that squares the
  // remaining error: up to 1e-13 near the ends, where P_n is steep.
  double guess = std::cos(std::numbers::pi * (n - 1 - k + 0.75) / (n + 0.5));
  if (2 * k == n - 1) guess = 0;
  for (int iteration = 0; iteration < 8; ++iteration) {
    double value = 0, derivative = 0;
    legendre(n, guess, value, derivative);
    if (2 * k != n - 1) guess -= value / derivative;
  }
  Wide x = guess, value = 0, derivative = 0;
  legendre(n, x, value, derivative);
  const Wide step = 2 * k == n - 1 ? Wide(0) : -value / derivative;
  // P' is updated too: Legendre's equation gives P''.
  derivative += step * (2 * x * derivative - n * (n + 1) * value) / (1 - x * x);
  x += step;
  return {static_cast<double>(x), static_cast<double>(2 / ((1 - x * x) * derivative * derivative))};
}

/// The rules of `first` to `last` points.
///
/// n points integrate polynomials of degree 2n − 1 exactly. Rules are stored one after the other, n
/// numbers each.
struct RuleTable {
  std::vector<double> abscissae, weights;  // those of n points begin at place(n)

  std::size_t place(int n) const { return static_cast<std::size_t>(n * (n - 1) / 2 - before_); }

  RuleTable(int first, int last) : before_(first * (first - 1) / 2) {
    abscissae.resize(place(last + 1));
    weights.resize(abscissae.size());
    for (int n = first; n <= last; ++n) {
      // The rule is symmetric: nodes are found in the right half and mirrored exactly.
      for (int k = n / 2; k < n; ++k) {
        const Node right = node(n, k);
        const std::size_t at = place(n) + static_cast<std::size_t>(k);
        const std::size_t mirrored = place(n) + static_cast<std::size_t>(n - 1 - k);
        abscissae[mirrored] = -right.abscissa;
        abscissae[at] = right.abscissa;
        weights[at] = weights[mirrored] = right.weight;
      }
    }
  }

 private:
  int before_;
};

/// All rules together would take longer than most commands, which need none of more points.
constexpr int few_points = 16;

const RuleTable& table_of(int n) {
  if (n <= few_points) {
    static const RuleTable few(1, few_points);
    return few;
  }
  static const RuleTable many(few_points + 1, max_gauss_points);
  return many;
}

}  // namespace

GaussRule gauss_legendre(int n) {
  assert(n >= 1 && n <= max_gauss_points);
  const RuleTable& table = table_of(n);
  const std::size_t at = table.place(n), size = static_cast<std::size_t>(n);
  return {std::span(table.abscissae).subspan(at, size), std::span(table.weights).subspan(at, size)};
}

}  // namespace knead
