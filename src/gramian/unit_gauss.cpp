#include "unit_gauss.hpp"

#include <cassert>
#include <cstddef>
#include <vector>

#include "base/gauss_legendre.hpp"

namespace knead::detail {
namespace {

static_assert(max_unit_gauss_points <= max_gauss_points);

template <class Real>
struct Tables {
  std::vector<Real> t, complement, weights;

  static std::size_t offset(int n) { return static_cast<std::size_t>(n) * static_cast<std::size_t>(n - 1) / 2; }

  Tables() {
    for (int n = 1; n <= max_unit_gauss_points; ++n) {
      for (const double guess : gauss_legendre(n).abscissae) add(n, guess);
    }
  }

  /// Newton steps from the double in extended precision; then 1 ∓ x is exact enough to be halved.
  void add(int n, double guess) {
    long double x = guess, derivative = 0;
    for (int step = 0; step < 3; ++step) {
      long double p0 = 1, p1 = x;
      for (int m = 2; m <= n; ++m) {
        const long double p2 = ((2 * m - 1) * x * p1 - (m - 1) * p0) / m;
        p0 = p1;
        p1 = p2;
      }
      derivative = n * (x * p1 - p0) / (x * x - 1);
      if (step < 2 && guess != 0) x -= p1 / derivative;
    }
    t.push_back(static_cast<Real>((1 + x) / 2));
    complement.push_back(static_cast<Real>((1 - x) / 2));
    weights.push_back(static_cast<Real>(1 / ((1 - x * x) * derivative * derivative)));
  }
};

}  // namespace

template <class Real>
UnitGaussRule<Real> unit_gauss(int points) {
  assert(points >= 1 && points <= max_unit_gauss_points);
  static const Tables<Real> tables;
  const std::size_t at = Tables<Real>::offset(points), size = static_cast<std::size_t>(points);
  return {std::span(tables.t).subspan(at, size), std::span(tables.complement).subspan(at, size),
          std::span(tables.weights).subspan(at, size)};
}

template UnitGaussRule<double> unit_gauss<double>(int);
template UnitGaussRule<long double> unit_gauss<long double>(int);

}  // namespace knead::detail
