#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "knead/spline/evaluate.hpp"

namespace knead {

/// The rational basis R_i = w_i N_i / Σ w N and its partial derivatives on one element, by the quotient rule: with
/// A_i = w_i N_i and W = Σ A, ∂^a R = (∂^a A − Σ_{0 < b <= a} binom(a, b) ∂^b W ∂^{a−b} R) / W.
template <int D>
class RationalBasis {
 public:
  RationalBasis(const Spline<D>& spline, int order)
      : spline_(spline), indices_(multi_indices<D>(order)), net_(spline.net()) {
    local_ = 1;
    for (std::size_t d = 0; d < D; ++d) {
      width_[d] = spline.knots()[d].degree() + 1;
      local_ *= width_[d];
    }
    for (std::size_t k = 0; k < indices_.size(); ++k) {
      for (std::size_t l = 1; l <= k; ++l) {
        MultiIndex<D> rest{};
        double factor = 1;
        bool below = true;
        for (std::size_t d = 0; d < D; ++d) {
          rest[d] = indices_[k][d] - indices_[l][d];
          below = below && rest[d] >= 0;
          for (int i = 1; below && i <= indices_[l][d]; ++i) factor = factor * (rest[d] + i) / i;
        }
        if (below) lower_.push_back({k, l, static_cast<std::size_t>(multi_index_position<D>(rest)), factor});
      }
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

  /// Writes column `point` of out[a](local function, point) for every multi-index a. `rows[d]` is row 0 of a table of
  /// the given order at this point. Error: the denominator is not positive.
  [[nodiscard]] Expected<void> evaluate(const std::array<int, D>& first, const std::array<const double*, D>& rows,
                                        Eigen::Index point, std::vector<Eigen::MatrixXd>& out) const {
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
        for (std::size_t d = 0; d < D; ++d) product *= rows[d][indices_[k][d] * width_[d] + offset[d]];
        out[k](r, point) = product;
        sums[k] += product;
      }
    }
    if (!(sums[0] > 0)) {
      return numerical_error("the rational denominator is not positive", "stiffness", "use positive weights");
    }
    std::size_t at = 0;
    for (std::size_t k = 0; k < indices_.size(); ++k) {
      auto column = out[k].col(point);
      for (; at < lower_.size() && lower_[at].k == k; ++at) {
        column -= (lower_[at].factor * sums[lower_[at].l]) * out[lower_[at].rest].col(point);
      }
      column /= sums[0];
    }
    return {};
  }

 private:
  struct Lower {
    std::size_t k, l, rest;
    double factor;
  };

  const Spline<D>& spline_;
  std::vector<MultiIndex<D>> indices_;
  std::vector<Lower> lower_;
  std::array<int, D> net_, width_{};
  int local_ = 1;
};

}  // namespace knead
