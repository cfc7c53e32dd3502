#pragma once

#include <cmath>
#include <vector>

#include "knead/spline/knot_vector.hpp"

/// Reference values in quadruple precision (113 bits): sums of positive terms come out right to
/// about 1e-32, sums that cancel to 1e-32 of their terms. Written independently of the library: its
/// own basis functions, derivatives and rule.
namespace knead::testing {

__extension__ typedef __float128 Quad;

inline Quad magnitude(Quad x) { return x < 0 ? -x : x; }

struct QuadRule {
  std::vector<Quad> t, weight;  ///< Gauss–Legendre on [0, 1]
};

inline QuadRule quad_rule(int n) {
  QuadRule rule;
  for (int k = 1; k <= n; ++k) {
    Quad x = std::cos(3.14159265358979323846 * (k - 0.25) / (n + 0.5)), derivative = 0;
    for (int step = 0; step < 8; ++step) {
      Quad p1 = 1, p2 = 0;
      for (int j = 1; j <= n; ++j) {
        const Quad p3 = p2;
        p2 = p1;
        p1 = ((2 * j - 1) * x * p2 - (j - 1) * p3) / j;
      }
      derivative = n * (x * p1 - p2) / (x * x - 1);
      x -= p1 / derivative;
    }
    rule.t.push_back((1 - x) / 2);
    rule.weight.push_back(1 / ((1 - x * x) * derivative * derivative));
  }
  return rule;
}

/// N_i^(d)(u) of degree q, the polynomial piece of span s, by the defining recursion (Cox–de Boor;
/// a function without support counts as zero).
template <class Knots>
Quad quad_basis(const Knots& x, int i, int q, int d, int s, Quad u) {
  if (d > q || i > s || s > i + q) return 0;
  if (q == 0) return 1;
  const Quad left = Quad(x[i + q]) - Quad(x[i]), right = Quad(x[i + q + 1]) - Quad(x[i + 1]);
  Quad value = 0;
  if (d > 0) {
    if (left > 0) value += q / left * quad_basis(x, i, q - 1, d - 1, s, u);
    if (right > 0) value -= q / right * quad_basis(x, i + 1, q - 1, d - 1, s, u);
  } else {
    if (left > 0) value += (u - Quad(x[i])) / left * quad_basis(x, i, q - 1, 0, s, u);
    if (right > 0) value += (Quad(x[i + q + 1]) - u) / right * quad_basis(x, i + 1, q - 1, 0, s, u);
  }
  return value;
}

/// The sign of the second term of a derivative, N' = q (N/d − N/d): `magnitudes` adds up what
/// `values` subtracts, which gives the sum of the magnitudes of all terms, the size that rounding
/// errors are relative to.
enum class Terms { values, magnitudes };

/// All p + 1 functions of span s at once, order d, in O(p²): the same recursion by levels. out[r] =
/// N_{s-p+r}^(d)(u).
template <class Knots>
std::vector<Quad> quad_span_basis(const Knots& x, int p, int d, int s, Quad u,
                                  Terms terms = Terms::values) {
  const int sign = terms == Terms::values ? -1 : 1;
  std::vector<Quad> level(static_cast<std::size_t>(p) + 1, Quad(0));
  if (d > p) return level;
  level[0] = 1;
  for (int q = 1; q <= p; ++q) {
    Quad before = 0;
    for (int r = 0; r <= q; ++r) {
      const auto at = static_cast<std::size_t>(r);
      Quad here = 0, after = 0;
      if (r < q) {
        const Quad lower = Quad(x[s + 1 - q + r]), upper = Quad(x[s + 1 + r]),
                   quotient = level[at] / (upper - lower);
        here = q > p - d ? sign * q * quotient : (upper - u) * quotient;
        after = q > p - d ? q * quotient : (u - lower) * quotient;
      }
      level[at] = here + before;
      before = after;
    }
  }
  return level;
}

/// G^ab and ∫|N_i^(a) N_j^(b)| (the latter by the points of the rule), as full rows of the band:
/// row i, column j − i + p. By `Terms::magnitudes` the latter is the integral of the products of
/// the sums of magnitudes instead.
struct QuadGramian {
  int n = 0, p = 0;
  std::vector<Quad> values, absolutes;
  [[nodiscard]] std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(2 * p + 1) +
           static_cast<std::size_t>(j - i + p);
  }
  [[nodiscard]] Quad value(int i, int j) const {
    return i - j > p || j - i > p ? Quad(0) : values[at(i, j)];
  }
  [[nodiscard]] Quad absolute(int i, int j) const {
    return i - j > p || j - i > p ? Quad(0) : absolutes[at(i, j)];
  }
};

inline QuadGramian quad_gramian(const KnotVector& knots, int a, int b,
                                Terms beside = Terms::values) {
  const int p = knots.degree(), n = knots.count();
  QuadGramian result{n, p, {}, {}};
  result.values.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(2 * p + 1), Quad(0));
  result.absolutes = result.values;
  const QuadRule rule = quad_rule(p + 1);
  for (const int s : knots.spans()) {
    const Quad h = Quad(knots[s + 1]) - Quad(knots[s]);
    for (std::size_t g = 0; g < rule.t.size(); ++g) {
      const Quad u = Quad(knots[s]) + h * rule.t[g], weight = h * rule.weight[g];
      const std::vector<Quad> f = quad_span_basis(knots, p, a, s, u);
      const std::vector<Quad> h_b = a == b ? f : quad_span_basis(knots, p, b, s, u);
      std::vector<Quad> size_a = f, size_b = h_b;
      if (beside == Terms::magnitudes) {
        size_a = quad_span_basis(knots, p, a, s, u, beside);
        size_b = quad_span_basis(knots, p, b, s, u, beside);
      }
      for (std::size_t i = 0; i < f.size(); ++i) {
        for (std::size_t j = 0; j < f.size(); ++j) {
          const std::size_t at =
              result.at(s - p + static_cast<int>(i), s - p + static_cast<int>(j));
          result.values[at] += weight * f[i] * h_b[j];
          result.absolutes[at] += magnitude(weight * size_a[i] * size_b[j]);
        }
      }
    }
  }
  return result;
}

}  // namespace knead::testing
