#include "rational_piece.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace knead::detail {
namespace {

constexpr int orders = (rational_order + 1) * (rational_order + 2) / 2;
constexpr double binomial[3][3] = {{1, 0, 0}, {1, 1, 0}, {1, 2, 1}};

/// |T_k| <= (ρ^k + ρ^−k)/2 on the ellipse.
double growth(double rho, int k) { return 0.5 * (std::pow(rho, k) + std::pow(rho, -k)); }

/// The quotient rule for R = A/W: W R^(k,l) = A^(k,l) − Σ_{(i,j) ≠ 0} C(k,i) C(l,j) W^(i,j) R^(k−i,l−j), in order. With
/// `sign` +1 instead of −1 and bounds instead of values it bounds R^(k,l).
template <class Numerator>
void quotient(const double (&w)[orders], double w0, double sign, Numerator numerator, double (&r)[orders]) {
  for (int total = 0; total <= rational_order; ++total) {
    for (int l = 0; l <= total; ++l) {
      const int k = total - l;
      double sum = numerator(k, l);
      for (int i = 0; i <= k; ++i) {
        for (int j = 0; j <= l; ++j) {
          if (i + j == 0) continue;
          sum += sign * binomial[k][i] * binomial[l][j] * w[order_index(i, j)] * r[order_index(k - i, l - j)];
        }
      }
      r[order_index(k, l)] = sum / w0;
    }
  }
}

}  // namespace

void RationalAxis::values(double t, double complement, SpanValues<double> (&out)[3]) const {
  if (knots == nullptr) {
    out[0][0] = 1;
    out[1][0] = out[2][0] = 0;
    return;
  }
  const int all[3] = {0, 1, 2};
  span_basis(*knots, span, lower, upper, t, complement, all, 3, out);
}

void RationalAxis::tabulate() {
  const int width = degree() + 1;
  chebyshev.assign(static_cast<std::size_t>(3 * width * width), 0.0);
  SpanValues<double> at[3];
  for (int m = 0; m < width; ++m) {
    const double angle = std::numbers::pi * (m + 0.5) / width;
    // cos² and sin² of the half angle: both t and 1 − t without cancellation.
    const double c = std::cos(angle / 2), s = std::sin(angle / 2);
    values(c * c, s * s, at);
    for (int d = 0; d < 3; ++d) {
      for (int r = 0; r < width; ++r) {
        for (int k = 0; k < width; ++k) {
          const double factor = (k == 0 ? 1.0 : 2.0) / width * std::cos(k * angle);
          chebyshev[static_cast<std::size_t>((d * width + r) * width + k)] += factor * at[d][r];
        }
      }
    }
  }
}

RationalAxis RationalAxis::half(int which) const {
  RationalAxis result{knots, span, lower, upper};
  const double middle = lower + 0.5 * (upper - lower);
  (which == 0 ? result.upper : result.lower) = middle;
  result.tabulate();
  return result;
}

RationalPiece::RationalPiece(std::array<RationalAxis, 2> axes, const double* weights)
    : axes_(std::move(axes)), weights_(weights) {
  const int m = axis(0).degree() + 1, n = axis(1).degree() + 1;
  denominator_.assign(static_cast<std::size_t>(orders * m * n), 0.0);
  for (int total = 0; total <= rational_order; ++total) {
    for (int j = 0; j <= total; ++j) {
      const int i = total - j, order = order_index(i, j);
      for (int r = 0; r < m; ++r) {
        for (int s = 0; s < n; ++s) {
          for (int k = 0; k < m; ++k) {
            for (int l = 0; l < n; ++l) {
              denominator_[static_cast<std::size_t>((order * m + k) * n + l)] +=
                  weights[r * n + s] * axis(0).chebyshev[static_cast<std::size_t>((i * m + r) * m + k)] *
                  axis(1).chebyshev[static_cast<std::size_t>((j * n + s) * n + l)];
            }
          }
        }
      }
    }
  }
}

void RationalPiece::evaluate(const SpanValues<double> (&u)[3], const SpanValues<double> (&v)[3], double* out) const {
  const int m = axis(0).degree() + 1, n = axis(1).degree() + 1;
  double w[orders] = {};
  for (int total = 0; total <= rational_order; ++total) {
    for (int j = 0; j <= total; ++j) {
      for (int r = 0; r < m; ++r) {
        double sum = 0;
        for (int s = 0; s < n; ++s) sum += weights_[r * n + s] * v[j][s];
        w[order_index(total - j, j)] += u[total - j][r] * sum;
      }
    }
  }
  for (int r = 0; r < m; ++r) {
    for (int s = 0; s < n; ++s) {
      const double weight = weights_[r * n + s];
      double value[orders];
      quotient(
          w, w[0], -1, [&](int k, int l) { return weight * u[k][r] * v[l][s]; }, value);
      for (int o = 0; o < orders; ++o) out[o * functions() + r * n + s] = value[o];
    }
  }
}

double RationalPiece::bound(double rho_u, double rho_v, std::array<int, 2> a, std::array<int, 2> b) const {
  const int m = axis(0).degree() + 1, n = axis(1).degree() + 1;
  std::array<double, max_degree + 1> grow_u{}, grow_v{};
  for (int k = 0; k < m; ++k) grow_u[static_cast<std::size_t>(k)] = growth(rho_u, k);
  for (int l = 0; l < n; ++l) grow_v[static_cast<std::size_t>(l)] = growth(rho_v, l);

  double w[orders] = {};  // upper bounds of |∂^o W|
  for (int o = 0; o < orders; ++o) {
    for (int k = 0; k < m; ++k) {
      for (int l = 0; l < n; ++l) {
        w[o] += std::abs(denominator_coefficient(o, k, l)) * grow_u[static_cast<std::size_t>(k)] *
                grow_v[static_cast<std::size_t>(l)];
      }
    }
  }
  // |W| >= the mean coefficient minus all others.
  const double lowest = 2 * denominator_coefficient(0, 0, 0) - w[0];
  if (!(lowest > 0)) return std::numeric_limits<double>::infinity();

  const auto function_bound = [&](int direction, int d, int r) {
    const RationalAxis& along = axis(direction);
    const int width = along.degree() + 1;
    const auto& grow = direction == 0 ? grow_u : grow_v;
    double sum = 0;
    for (int k = 0; k < width; ++k) {
      sum += std::abs(along.chebyshev[static_cast<std::size_t>((d * width + r) * width + k)]) *
             grow[static_cast<std::size_t>(k)];
    }
    return sum;
  };
  double largest_a = 0, largest_b = 0;
  double u[3][max_degree + 1], v[3][max_degree + 1];
  for (int d = 0; d < 3; ++d) {
    for (int r = 0; r < m; ++r) u[d][r] = function_bound(0, d, r);
    for (int s = 0; s < n; ++s) v[d][s] = function_bound(1, d, s);
  }
  for (int r = 0; r < m; ++r) {
    for (int s = 0; s < n; ++s) {
      const double weight = weights_[r * n + s];
      double value[orders];
      quotient(
          w, lowest, 1, [&](int k, int l) { return weight * u[k][r] * v[l][s]; }, value);
      largest_a = std::max(largest_a, value[order_index(a[0], a[1])]);
      largest_b = std::max(largest_b, value[order_index(b[0], b[1])]);
    }
  }
  return largest_a * largest_b;
}

double RationalPiece::variation(int direction) const {
  double sum = 0;
  for (int k = 0; k <= axis(0).degree(); ++k) {
    for (int l = 0; l <= axis(1).degree(); ++l) {
      if ((direction == 0 ? k : l) > 0) sum += std::abs(denominator_coefficient(0, k, l));
    }
  }
  return sum;
}

}  // namespace knead::detail
