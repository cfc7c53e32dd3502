#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "rational_piece.hpp"

namespace knead::detail {

/// The elements of a rational net one after the other: products of spans, cut where breaks lie
/// inside.
template <int D>
class RationalElements {
 public:
  /// `breaks` may lie anywhere, in any order. Knots and weights must outlive the elements.
  RationalElements(const std::array<const KnotVector*, D>& knots, std::span<const double> weights,
                   std::array<std::vector<double>, D> breaks = {})
      : all_weights_(weights) {
    for (std::size_t d = 0; d < D; ++d) {
      axes_[d] = axes_between(*knots[d], std::move(breaks[d]));
      net_[d] = knots[d]->count();
      width_[d] = static_cast<std::size_t>(knots[d]->degree() + 1);
      functions_ *= width_[d];
    }
    indices_.resize(functions_);
    rows_.resize(functions_);
    weights_.resize(functions_);
  }

  /// How many functions an element has.
  [[nodiscard]] std::size_t functions() const { return functions_; }
  [[nodiscard]] double count() const {
    double product = 1;
    for (const auto& axes : axes_) product *= static_cast<double>(axes.size());
    return product;
  }

  /// Calls visit(piece) for every element in order, until it returns false.
  template <class Visit>
  bool for_each(const Visit& visit) {
    std::array<std::size_t, D> element{};
    for (;;) {
      std::array<const RationalAxis*, D> axes;
      for (std::size_t d = 0; d < D; ++d) axes[d] = &axes_[d][element[d]];
      enter(axes);
      if (!visit(RationalPiece<D>(axes, weights_.data()))) return false;
      std::size_t d = D;
      while (d-- > 0 && ++element[d] == axes_[d].size()) element[d] = 0;
      if (d >= D) return true;
    }
  }

  /// Of the element visited: the functions by their place in the net, last direction fastest, by
  /// their indices, and their weights.
  [[nodiscard]] const std::vector<int>& rows() const { return rows_; }
  [[nodiscard]] const std::vector<std::array<int, D>>& indices() const { return indices_; }
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }

  /// Which part of a product of whole spans a piece is.
  [[nodiscard]] static double share(const RationalPiece<D>& piece) {
    double product = 1;
    for (const RationalAxis* axis : piece.axes()) {
      product *= axis->length() / ((*axis->knots)[axis->span + 1] - (*axis->knots)[axis->span]);
    }
    return product;
  }

 private:
  static std::vector<RationalAxis> axes_between(const KnotVector& knots,
                                                std::vector<double> breaks) {
    std::ranges::sort(breaks);
    std::vector<RationalAxis> result;
    for (const int span : knots.spans()) {
      double lower = knots[span];
      for (auto next = std::ranges::upper_bound(breaks, lower); lower < knots[span + 1]; ++next) {
        const double upper =
            next == breaks.end() ? knots[span + 1] : std::min(*next, knots[span + 1]);
        if (upper > lower) result.emplace_back(knots, span, lower, upper);  // else a repeated break
        lower = upper;
        if (next == breaks.end()) break;
      }
    }
    return result;
  }

  void enter(const std::array<const RationalAxis*, D>& axes) {
    for (std::size_t r = 0; r < functions_; ++r) {
      std::size_t rest = r;
      for (std::size_t d = D; d-- > 0;) {
        indices_[r][d] = axes[d]->first() + static_cast<int>(rest % width_[d]);
        rest /= width_[d];
      }
      int row = 0;
      for (std::size_t d = 0; d < D; ++d) row = row * net_[d] + indices_[r][d];
      rows_[r] = row;
      weights_[r] = all_weights_[static_cast<std::size_t>(row)];
    }
  }

  std::span<const double> all_weights_;
  std::array<std::vector<RationalAxis>, D> axes_;
  std::array<int, D> net_;
  std::array<std::size_t, D> width_;
  std::size_t functions_ = 1;
  std::vector<std::array<int, D>> indices_;
  std::vector<int> rows_;
  std::vector<double> weights_;
};

}  // namespace knead::detail
