#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "spline/quotient_rule.hpp"

namespace knead {

/// The rational basis R_i = w_i N_i / Σ w N and its partial derivatives on one element, by the
/// quotient rule: with A_i = w_i N_i and W = Σ A (see `detail::QuotientRule`).
template <int D>
class RationalBasis {
 public:
  RationalBasis(const Spline<D>& spline, int order)
      : spline_(spline), indices_(multi_indices<D>(order)), rule_(order), net_(spline.net()) {
    local_ = 1;
    for (std::size_t d = 0; d < D; ++d) {
      width_[d] = spline.knots()[d].degree() + 1;
      local_ *= width_[d];
    }
  }

  /// The global multi-index of local function r when the element's first functions are `first`.
  [[nodiscard]] std::array<int, D> global(const std::array<int, D>& first, int r) const {
    std::array<int, D> i;
    for (std::size_t d = D; d-- > 0;) {
      i[d] = first[d] + r % width_[d];
      r /= width_[d];
    }
    return i;
  }

  /// Writes column `point` of out[a](local function, point) for every multi-index a. `rows[d]` is
  /// row 0 of a table of the given order at this point. Error: the denominator is not positive.
  [[nodiscard]] Expected<void> evaluate(const std::array<int, D>& first,
                                        const std::array<const double*, D>& rows,
                                        Eigen::Index point,
                                        std::vector<Eigen::MatrixXd>& out) const {
    std::vector<double> sums(indices_.size(), 0.0);
    for (int r = 0; r < local_; ++r) {
      int index = 0;
      std::array<int, D> offset;
      for (std::size_t d = D, rest = static_cast<std::size_t>(r); d-- > 0;) {
        offset[d] = static_cast<int>(rest % static_cast<std::size_t>(width_[d]));
        rest /= static_cast<std::size_t>(width_[d]);
      }
      for (std::size_t d = 0; d < D; ++d) index = index * net_[d] + first[d] + offset[d];
      const double weight = spline_.weights()[static_cast<std::size_t>(index)];
      for (std::size_t k = 0; k < indices_.size(); ++k) {
        double product = weight;
        for (std::size_t d = 0; d < D; ++d)
          product *= rows[d][indices_[k][d] * width_[d] + offset[d]];
        out[k](r, point) = product;
        sums[k] += product;
      }
    }
    if (!(sums[0] > 0)) {
      return numerical_error("the rational denominator is not positive", "stiffness",
                             "use positive weights");
    }
    for (std::size_t k = 0; k < indices_.size(); ++k) {
      auto column = out[k].col(point);
      for (const auto& term : rule_.terms(k)) {
        column -= (term.factor * sums[term.denominator]) * out[term.rest].col(point);
      }
      column /= sums[0];
    }
    return {};
  }

 private:
  const Spline<D>& spline_;
  std::vector<MultiIndex<D>> indices_;
  detail::QuotientRule<D> rule_;
  std::array<int, D> net_, width_{};
  int local_ = 1;
};

}  // namespace knead
