#pragma once

#include <array>
#include <vector>

#include "knead/spline/evaluate.hpp"
#include "support/quad_gramian.hpp"

namespace knead::testing {

/// Σ of the magnitudes of the terms that `quad_span_basis` sums: what rounding errors of derivatives are relative to.
inline std::vector<Quad> term_magnitudes(const KnotVector& x, int p, int d, int s, Quad u) {
  std::vector<Quad> level(static_cast<std::size_t>(p) + 1, Quad(0));
  if (d > p) return level;
  level[0] = 1;
  for (int q = 1; q <= p; ++q) {
    Quad before = 0;
    for (int r = 0; r <= q; ++r) {
      const auto at = static_cast<std::size_t>(r);
      Quad here = 0, after = 0;
      if (r < q) {
        const Quad lower = Quad(x[s + 1 - q + r]), upper = Quad(x[s + 1 + r]), quotient = level[at] / (upper - lower);
        here = q > p - d ? q * quotient : (upper - u) * quotient;
        after = q > p - d ? q * quotient : (u - lower) * quotient;
      }
      level[at] = here + before;
      before = after;
    }
  }
  return level;
}

/// Numerator and denominator of a rational spline at one point, by their defining sums in quadruple precision.
template <int D>
struct QuadReference {
  const Spline<D>& spline;
  std::array<double, D> u;

  struct Homogeneous {
    std::array<Quad, 4> value{};  ///< ∂^a of (w x, w y, w z, w)
    Quad size = 0;                ///< Σ of the magnitudes of the terms of ∂^a w
  };

  [[nodiscard]] Homogeneous homogeneous(const MultiIndex<D>& a) const {
    std::array<std::vector<Quad>, D> basis, magnitudes;
    std::array<int, D> first;
    for (std::size_t d = 0; d < D; ++d) {
      const KnotVector& knots = spline.knots()[d];
      const int p = knots.degree(), span = knots.find_span(u[d]);
      first[d] = span - p;
      basis[d] = quad_span_basis(knots, p, a[d], span, u[d]);
      magnitudes[d] = term_magnitudes(knots, p, a[d], span, u[d]);
    }
    Homogeneous sum;
    const auto net = spline.net();
    for (int row = 0; row < spline.size(); ++row) {
      Quad product = spline.weights()[static_cast<std::size_t>(row)], size = product;
      int rest = row;
      for (std::size_t d = D; d-- > 0;) {
        const int r = rest % net[d] - first[d];
        const bool lives = 0 <= r && r < static_cast<int>(basis[d].size());
        product *= lives ? basis[d][static_cast<std::size_t>(r)] : Quad(0);
        size *= lives ? magnitudes[d][static_cast<std::size_t>(r)] : Quad(0);
        rest /= net[d];
      }
      for (std::size_t c = 0; c < 3; ++c) {
        sum.value[c] += product * spline.control_points()(row, static_cast<Eigen::Index>(c));
      }
      sum.value[3] += product;
      sum.size += size;
    }
    return sum;
  }
};

}  // namespace knead::testing
