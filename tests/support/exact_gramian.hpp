#pragma once

#include <gmpxx.h>

#include <vector>

#include "knead/spline/knot_vector.hpp"
#include "support/quad_gramian.hpp"

/// Gramians in exact rational arithmetic: doubles are rationals, and so is all that follows from
/// them. Slow; it shows that quadruple precision is good enough as the reference for everything
/// else.
namespace knead::testing {

using Polynomial = std::vector<mpq_class>;  ///< coefficients of 1, v, v², …

/// The d-th derivatives of the p + 1 functions of span s, as polynomials of v = u − x_s.
inline std::vector<Polynomial> exact_span_basis(const KnotVector& x, int d, int s) {
  const int p = x.degree();
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const auto knot = [&](int i) { return mpq_class(mpq_class(x[i]) - mpq_class(x[s])); };
  std::vector<Polynomial> level(at(p + 1), Polynomial(at(p + 1)));
  level[0][0] = 1;
  for (int q = 1; q <= p; ++q) {
    std::vector<Polynomial> next(at(p + 1), Polynomial(at(p + 1)));
    for (int r = 0; r < q; ++r) {
      const mpq_class lower = knot(s + 1 - q + r), upper = knot(s + 1 + r), length = upper - lower;
      for (int k = 0; k < q; ++k) {
        const mpq_class c = level[at(r)][at(k)] / length;
        next[at(r)][at(k)] += upper * c;
        next[at(r)][at(k + 1)] -= c;
        next[at(r + 1)][at(k)] -= lower * c;
        next[at(r + 1)][at(k + 1)] += c;
      }
    }
    level = std::move(next);
  }
  for (Polynomial& f : level) {
    for (int times = 0; times < d; ++times) {
      for (int k = 0; k < p; ++k) f[at(k)] = (k + 1) * f[at(k + 1)];
      f[at(p)] = 0;
    }
  }
  return level;
}

/// G^ab, full rows of the band as in `QuadGramian`: row i, column j − i + p.
inline std::vector<mpq_class> exact_gramian(const KnotVector& x, int a, int b) {
  const int p = x.degree();
  std::vector<mpq_class> values(static_cast<std::size_t>(x.count()) *
                                static_cast<std::size_t>(2 * p + 1));
  if (a > p || b > p) return values;
  for (const int s : x.spans()) {
    const std::vector<Polynomial> f = exact_span_basis(x, a, s), g = exact_span_basis(x, b, s);
    const mpq_class h = mpq_class(x[s + 1]) - mpq_class(x[s]);
    std::vector<mpq_class> integral;  // of v^k over the span
    mpq_class power = h;
    for (int k = 0; k <= 2 * p; ++k, power *= h) integral.push_back(power / (k + 1));
    for (int i = 0; i <= p; ++i) {
      for (int j = 0; j <= p; ++j) {
        mpq_class& sum = values[static_cast<std::size_t>((s - p + i) * (2 * p + 1) + j - i + p)];
        for (std::size_t k = 0; k <= static_cast<std::size_t>(p - a); ++k) {
          for (std::size_t l = 0; l <= static_cast<std::size_t>(p - b); ++l) {
            sum += f[static_cast<std::size_t>(i)][k] * g[static_cast<std::size_t>(j)][l] *
                   integral[k + l];
          }
        }
      }
    }
  }
  return values;
}

/// Exactly, as a sum of doubles. For magnitudes that doubles can hold.
inline mpq_class rational(Quad x) {
  mpq_class sum = 0;
  for (int part = 0; part < 3; ++part) {
    const double high = static_cast<double>(x);
    sum += mpq_class(high);
    x -= Quad(high);
  }
  return sum;
}

}  // namespace knead::testing
