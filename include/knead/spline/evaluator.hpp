#pragma once

#include <array>
#include <span>

#include "knead/spline/evaluate.hpp"

namespace knead {

/// `evaluate` for bases that were tabulated before (to `order` at least): point k is row k of every table, all of one
/// size. Memory that `result` holds is used again. After a failure the content of `result` is unspecified. Errors: a
/// denominator that is not positive (numerical).
template <int D>
[[nodiscard]] Expected<void> evaluate(const Spline<D>& spline, const std::array<const BasisTable*, D>& tables,
                                      int order, Evaluation<D>& result);

/// The basis functions at parameters that stay while control points change: evaluation without tabulating them anew.
/// The same bits as `evaluate` and `evaluate_grid`. Immutable, independent of the spline it was made for.
template <int D>
class Evaluator {
 public:
  /// On the grid of all combinations of the given parameters, last direction fastest, to derivatives of total order
  /// `order`. At a knot the limit from `side`. Errors: a parameter outside the domain or not finite, named by direction
  /// and index (input); a negative order (usage). Cost: O(p²) per parameter of each direction.
  [[nodiscard]] static Expected<Evaluator> on_grid(const std::array<KnotVector, D>& knots,
                                                   const std::array<std::span<const double>, D>& parameters,
                                                   int order = 0, Side side = Side::right);

  /// At scattered points. Likewise; cost: O(D p²) per point, about as much as evaluating points once.
  [[nodiscard]] static Expected<Evaluator> at_points(const std::array<KnotVector, D>& knots,
                                                     const Parameters<D>& parameters, int order = 0,
                                                     Side side = Side::right);

  [[nodiscard]] int order() const { return tables_[0].order; }
  /// Number of points.
  [[nodiscard]] Eigen::Index size() const;

  /// S and its derivatives for a spline with these knots, rational or not. Memory that `result` holds is used again;
  /// after a failure its content is unspecified.
  /// Errors: other knots (usage); a denominator that is not positive (numerical).
  [[nodiscard]] Expected<void> evaluate(const Spline<D>& spline, Evaluation<D>& result) const;
  [[nodiscard]] Expected<Evaluation<D>> evaluate(const Spline<D>& spline) const;

 private:
  Evaluator(std::array<KnotVector, D> knots, std::array<BasisTable, D> tables, bool grid)
      : knots_(std::move(knots)), tables_(std::move(tables)), grid_(grid) {}
  [[nodiscard]] static Expected<Evaluator> create(const std::array<KnotVector, D>& knots,
                                                  const std::array<std::span<const double>, D>& parameters, int order,
                                                  Side side, bool grid);

  std::array<KnotVector, D> knots_;
  std::array<BasisTable, D> tables_;
  bool grid_;
};

}  // namespace knead
