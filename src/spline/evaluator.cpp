#include "knead/spline/evaluate.hpp"

#include <fmt/format.h>

namespace knead {

template <int D>
Expected<Evaluator<D>> Evaluator<D>::create(
    const std::array<KnotVector, D>& knots,
    const std::array<std::span<const double>, D>& parameters, int order, Side side, bool grid) {
  std::array<BasisTable, D> tables;
  for (std::size_t d = 0; d < D; ++d) {
    auto table = tabulate_basis(knots[d], parameters[d], order, side);
    if (!table) return std::unexpected(table.error().within(fmt::format("direction {}", d)));
    tables[d] = std::move(*table);
  }
  return Evaluator(knots, std::move(tables), grid);
}

template <int D>
Expected<Evaluator<D>> Evaluator<D>::on_grid(
    const std::array<KnotVector, D>& knots,
    const std::array<std::span<const double>, D>& parameters, int order, Side side) {
  return create(knots, parameters, order, side, true);
}

template <int D>
Expected<Evaluator<D>> Evaluator<D>::at_points(const std::array<KnotVector, D>& knots,
                                               const Parameters<D>& parameters, int order,
                                               Side side) {
  std::array<Eigen::VectorXd, D> columns;
  std::array<std::span<const double>, D> spans;
  for (std::size_t d = 0; d < D; ++d) {
    columns[d] = parameters.col(static_cast<Eigen::Index>(d));
    spans[d] = {columns[d].data(), static_cast<std::size_t>(columns[d].size())};
  }
  return create(knots, spans, order, side, false);
}

template <int D>
Eigen::Index Evaluator<D>::size() const {
  Eigen::Index count = tables_[0].size();
  for (std::size_t d = 1; grid_ && d < D; ++d) count *= tables_[d].size();
  return count;
}

template <int D>
Expected<void> Evaluator<D>::evaluate(const Spline<D>& spline, Evaluation<D>& result) const {
  for (std::size_t d = 0; d < D; ++d) {
    if (spline.knots()[d] == knots_[d]) continue;
    return usage_error("the spline has other knots than the evaluator was made for",
                       fmt::format("direction {}", d), "make an evaluator for its knots");
  }
  std::array<const BasisTable*, D> tables;
  for (std::size_t d = 0; d < D; ++d) tables[d] = &tables_[d];
  return grid_ ? evaluate_grid<D>(spline, tables, order(), result)
               : knead::evaluate<D>(spline, tables, order(), result);
}

template <int D>
Expected<Evaluation<D>> Evaluator<D>::evaluate(const Spline<D>& spline) const {
  Evaluation<D> result;
  if (auto status = evaluate(spline, result); !status)
    return std::unexpected(std::move(status.error()));
  return result;
}

template class Evaluator<1>;
template class Evaluator<2>;
template class Evaluator<3>;

}  // namespace knead
