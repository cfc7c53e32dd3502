#include "unit_gauss.hpp"

#include <cassert>
#include <cstddef>
#include <vector>

#include "base/gauss_legendre.hpp"
#include "double_double.hpp"

namespace knead::detail {
namespace {

static_assert(max_unit_gauss_points <= max_gauss_points);

struct Tables {
  std::vector<double> t, complement, weights;

  static std::size_t offset(int n) {
    return static_cast<std::size_t>(n) * static_cast<std::size_t>(n - 1) / 2;
  }

  Tables() : t(offset(max_unit_gauss_points + 1)), complement(t.size()), weights(t.size()) {
    for (int n = 1; n <= max_unit_gauss_points; ++n) {
      const std::size_t last = offset(n + 1) - 1;
      const std::span<const double> abscissae = gauss_legendre(n).abscissae;
      // The left half, whose mirror image the right one is.
      for (std::size_t k = 0; 2 * k < abscissae.size(); ++k)
        set(offset(n) + k, last - k, n, abscissae[k]);
    }
  }

  /// The points at `left` and `right` from the abscissa of the former: one Newton step in twice the
  /// precision squares its error, and 1 ∓ x can be halved.
  void set(std::size_t left, std::size_t right, int n, DoubleDouble x) {
    DoubleDouble value = x, before = 1;  // P_n and P_(n−1)
    for (int m = 2; m <= n; ++m) {
      const DoubleDouble next = ((2.0 * m - 1) * (x * value) - (m - 1.0) * before) / m;
      before = value;
      value = next;
    }
    const DoubleDouble one = 1;
    DoubleDouble derivative = double(n) * (x * value - before) / (x * x - one);
    const DoubleDouble step = x.high == 0 ? DoubleDouble(0) : -(value / derivative);
    // By Legendre's equation (1 − x²) P'' = 2 x P' − n (n + 1) P.
    derivative += step * (2.0 * (x * derivative) - n * (n + 1.0) * value) / (one - x * x);
    x += step;
    t[left] = complement[right] = static_cast<double>(0.5 * (one + x));
    t[right] = complement[left] = static_cast<double>(0.5 * (one - x));
    weights[left] = weights[right] =
        static_cast<double>(one / ((one - x * x) * derivative * derivative));
  }
};

}  // namespace

template <class Real>
UnitGaussRule<Real> unit_gauss(int points) {
  assert(points >= 1 && points <= max_unit_gauss_points);
  static const Tables tables;
  const std::size_t at = Tables::offset(points), size = static_cast<std::size_t>(points);
  return {std::span(tables.t).subspan(at, size), std::span(tables.complement).subspan(at, size),
          std::span(tables.weights).subspan(at, size)};
}

template UnitGaussRule<double> unit_gauss<double>(int);

}  // namespace knead::detail
