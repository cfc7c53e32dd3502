#pragma once

#include <array>
#include <vector>

#include "knead/spline/evaluate.hpp"
#include "support/quad_gramian.hpp"

namespace knead::testing {

/// Numerator and denominator of a rational spline at one point, by their defining sums in quadruple
/// precision.
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
      magnitudes[d] = quad_span_basis(knots, p, a[d], span, u[d], Terms::magnitudes);
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
