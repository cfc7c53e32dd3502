#pragma once

#include <cstddef>
#include <vector>

#include "knead/spline/evaluate.hpp"

namespace knead::detail {

/// The quotient rule for R = A/W in D variables:
///   W ∂^a R = ∂^a A − Σ_{0 < b <= a} binom(a, b) ∂^b W ∂^{a−b} R  (The NURBS Book, Eq. 4.20),
/// as a list of its terms for every a with |a| <= order, in the order of `multi_indices`.
template <int D>
class QuotientRule {
 public:
  /// − factor ∂^b W ∂^{a−b} R, by the positions of b and a − b.
  struct Term {
    std::size_t denominator, rest;
    double factor;
  };

  explicit QuotientRule(int order) {
    const std::vector<MultiIndex<D>> indices = multi_indices<D>(order);
    terms_.resize(indices.size());
    for (std::size_t k = 0; k < indices.size(); ++k) {
      for (std::size_t l = 1; l <= k; ++l) {
        MultiIndex<D> rest{};
        double factor = 1;
        bool below = true;
        for (std::size_t d = 0; d < D; ++d) {
          rest[d] = indices[k][d] - indices[l][d];
          below = below && rest[d] >= 0;
          for (int i = 1; below && i <= indices[l][d]; ++i) factor = factor * (rest[d] + i) / i;
        }
        if (below)
          terms_[k].push_back({l, static_cast<std::size_t>(multi_index_position<D>(rest)), factor});
      }
    }
  }

  /// How many derivatives there are.
  [[nodiscard]] std::size_t size() const { return terms_.size(); }
  /// The terms of derivative `a`, by its position.
  [[nodiscard]] const std::vector<Term>& terms(std::size_t a) const { return terms_[a]; }

 private:
  std::vector<std::vector<Term>> terms_;
};

}  // namespace knead::detail
