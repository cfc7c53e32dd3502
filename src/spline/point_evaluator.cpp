#include "point_evaluator.hpp"

#include <fmt/format.h>

namespace knead::detail {
namespace {

/// Room for one parameter.
template <int D>
std::array<BasisTable, D> tables_for(const Spline<D>& spline, int order) {
  std::array<BasisTable, D> tables;
  for (std::size_t d = 0; d < D; ++d) {
    const int degree = spline.knots()[d].degree();
    const auto size = static_cast<std::size_t>((order + 1) * (degree + 1));
    tables[d] = {degree, order, std::vector<int>(1), std::vector<double>(size)};
  }
  return tables;
}

template <int D>
std::array<const BasisTable*, D> pointers_to(const std::array<BasisTable, D>& tables) {
  std::array<const BasisTable*, D> pointers;
  for (std::size_t d = 0; d < D; ++d) pointers[d] = &tables[d];
  return pointers;
}

/// How many derivatives of total order up to this there are: binom(order + D, D).
template <int D>
std::size_t count_of(int order) {
  std::size_t count = 1;
  for (std::size_t d = 1; d <= D; ++d) count = count * (static_cast<std::size_t>(order) + d) / d;
  return count;
}

/// Of a net with as few control points as affect one point all are read.
template <int D>
bool all_affect(const Spline<D>& spline) {
  double terms = 1;
  for (const KnotVector& knots : spline.knots()) terms *= knots.degree() + 1;
  return terms >= spline.size();
}

}  // namespace

template <int D>
PointEvaluator<D>::PointEvaluator(const Spline<D>& spline, int order)
    : spline_(spline),
      tables_(tables_for(spline, order)),
      pointers_(pointers_to<D>(tables_)),
      net_(spline, all_affect(spline)),
      quotient_(spline.rational() ? order : 0),
      contraction_(net_, pointers_, order),
      homogeneous_(count_of<D>(order) * net_.width()),
      values_(count_of<D>(order) * 3) {
  for (std::size_t k = 0; k < count_of<D>(order); ++k) out_.push_back(values_.data() + 3 * k);
}

template <int D>
Expected<void> PointEvaluator<D>::at(const std::array<double, D>& u) {
  for (std::size_t d = 0; d < D; ++d) {
    const KnotVector& knots = spline_.knots()[d];
    BasisTable& table = tables_[d];
    if (!knots.domain().contains(u[d])) {  // which no NaN is
      const auto wrong = tabulate_basis(knots, {&u[d], 1}, table.order);
      return std::unexpected(wrong.error().within(fmt::format("direction {}", d)));
    }
    const int span = knots.find_span(u[d]);
    table.first[0] = span - knots.degree();
    basis_derivatives(knots, span, u[d], table.order, table.derivatives.data());
  }
  if (!spline_.rational()) {
    contraction_.point(0, values_.data());
    return {};
  }
  contraction_.point(0, homogeneous_.data());
  if (!divide_point<D>(quotient_, homogeneous_.data(), net_.width(), 0, out_))
    return denominator_error<1>({0});
  return {};
}

template class PointEvaluator<1>;
template class PointEvaluator<2>;
template class PointEvaluator<3>;

}  // namespace knead::detail
