#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "support/quad_gramian.hpp"

namespace knead::testing {

/// ∫ R_i^(a) R_j^(b) in quadruple precision: each span in parts that halve towards both ends, where
/// the poles come near, 24 points each.
inline Eigen::MatrixXd quad_rational(const KnotVector& knots, const std::vector<double>& weights,
                                     int a, int b) {
  const int p = knots.degree(), n = knots.count();
  static const QuadRule rule = quad_rule(24);
  std::vector<Quad> sums(static_cast<std::size_t>(n * n), Quad(0));
  std::vector<Quad> cuts{0, 1};
  for (int k = 1; k <= 28; ++k) {
    const Quad x = Quad(std::ldexp(0.5, -k + 1));
    cuts.push_back(x);
    if (k > 1) cuts.push_back(1 - x);
  }
  std::sort(cuts.begin(), cuts.end());
  for (const int s : knots.spans()) {
    const Quad lower = knots[s], h = Quad(knots[s + 1]) - lower;
    for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
      for (std::size_t g = 0; g < rule.t.size(); ++g) {
        const Quad part = cuts[c + 1] - cuts[c], u = lower + h * (cuts[c] + part * rule.t[g]);
        std::vector<Quad> d[3];
        Quad w[3] = {};
        for (int order = 0; order < 3; ++order) {
          d[order] = quad_span_basis(knots, p, order, s, u);
          for (int r = 0; r <= p; ++r) {
            d[order][static_cast<std::size_t>(r)] *= weights[static_cast<std::size_t>(s - p + r)];
            w[order] += d[order][static_cast<std::size_t>(r)];
          }
        }
        const auto rational = [&](int order, int r) {
          const auto k = static_cast<std::size_t>(r);
          const Quad r0 = d[0][k] / w[0], r1 = (d[1][k] - w[1] * r0) / w[0];
          return order == 0 ? r0 : order == 1 ? r1 : (d[2][k] - 2 * w[1] * r1 - w[2] * r0) / w[0];
        };
        for (int i = 0; i <= p; ++i) {
          const Quad factor = h * part * rule.weight[g] * rational(a, i);
          for (int j = 0; j <= p; ++j) {
            sums[static_cast<std::size_t>((s - p + i) * n + s - p + j)] += factor * rational(b, j);
          }
        }
      }
    }
  }
  Eigen::MatrixXd result(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j)
      result(i, j) = static_cast<double>(sums[static_cast<std::size_t>(i * n + j)]);
  }
  return result;
}

}  // namespace knead::testing
