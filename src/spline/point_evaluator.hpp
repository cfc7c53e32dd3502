#pragma once

#include <array>
#include <vector>

#include "homogeneous.hpp"
#include "local_contraction.hpp"

namespace knead::detail {

/// S and its derivatives up to total order `order`, one point after another, in memory that is kept
/// between them: the bits of `evaluate`, at a fraction of its cost for a single point. It refers to
/// the spline, which must outlive it.
template <int D>
class PointEvaluator {
 public:
  PointEvaluator(const Spline<D>& spline, int order);
  PointEvaluator(const PointEvaluator&) = delete;
  PointEvaluator& operator=(const PointEvaluator&) = delete;

  /// Evaluates there, with the limit from the right at knots. Errors: those of `evaluate`.
  [[nodiscard]] Expected<void> at(const std::array<double, D>& u);
  /// The derivative of this position in `multi_indices`, at the last point.
  [[nodiscard]] Point derivative(std::size_t k) const { return Point(values_.data() + 3 * k); }
  [[nodiscard]] Point derivative(MultiIndex<D> a) const {
    return derivative(static_cast<std::size_t>(multi_index_position<D>(a)));
  }

 private:
  const Spline<D>& spline_;
  std::array<BasisTable, D> tables_;
  std::array<const BasisTable*, D> pointers_;
  HomogeneousNet<D> net_;
  QuotientRule<D> quotient_;
  LocalContraction<D> contraction_;
  std::vector<double> homogeneous_, values_;
  std::vector<double*> out_;  ///< of every derivative in `values_`
};

}  // namespace knead::detail
