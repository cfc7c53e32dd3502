#include "knead/gramian/rational_gramian.hpp"

#include <algorithm>
#include <vector>

#include "methods.hpp"
#include "rational_pairs.hpp"
#include "unit_gauss.hpp"

namespace knead {
namespace {

using detail::RationalElements;
using Orders = std::array<int, 2>;

/// add(row, column, value) for every pair of every element; the rest of the result into `summary`.
template <int D, class Matrix, class Add>
Expected<void> integrate(RationalElements<D> elements, std::size_t count, MultiIndex<D> a,
                         MultiIndex<D> b, double tolerance, RationalGramian<Matrix>& summary,
                         Add add) {
  const double size = detail::size_of_pairs<D>(elements, count, a, b);
  const auto functions = elements.functions();
  // An entry sums as many elements as there are functions on one.
  const double allowed = size > 0 ? tolerance * size / static_cast<double>(functions) : 1;
  detail::PairRule<D> rule(a, b, functions);
  double worst = 0;
  const bool positive = elements.for_each([&](const detail::RationalPiece<D>& piece) {
    if (!rule.integrate(piece, allowed)) return false;
    worst = std::max(worst, rule.error());
    for (std::size_t i = 0; i < functions; ++i) {
      for (std::size_t j = 0; j < functions; ++j)
        add(elements.rows()[i], elements.rows()[j], rule.sums()(i, j));
    }
    return true;
  });
  if (!positive) return detail::no_lower_bound();
  summary.error_bound = worst * static_cast<double>(functions);
  summary.pieces = rule.pieces();
  summary.largest_points = rule.largest_points();
  return {};
}

}  // namespace

Expected<RationalGramian<BandMatrix>> rational_gramian(const KnotVector& knots,
                                                       std::span<const double> weights, int a,
                                                       int b, double tolerance) {
  if (const auto good = detail::check_rational(weights, knots.count(), {a, 0}, {b, 0}, tolerance);
      !good) {
    return std::unexpected(good.error());
  }
  RationalGramian<BandMatrix> result{
      BandMatrix(knots.count(), knots.degree(), detail::symmetry_of(a, b))};
  const auto status = integrate<1>(RationalElements<1>({&knots}, weights), weights.size(), {a}, {b},
                                   tolerance, result, [&](int i, int j, double value) {
                                     if (a != b || i <= j) result.matrix.at(i, j) += value;
                                   });
  if (!status) return std::unexpected(status.error());
  return result;
}

Expected<RationalGramian<Eigen::SparseMatrix<double>>> rational_gramian(
    const std::array<KnotVector, 2>& knots, std::span<const double> weights, Orders a, Orders b,
    double tolerance) {
  const int count = knots[0].count() * knots[1].count();
  if (const auto good = detail::check_rational(weights, count, a, b, tolerance); !good)
    return std::unexpected(good.error());
  RationalGramian<Eigen::SparseMatrix<double>> result;
  std::vector<Eigen::Triplet<double>> triplets;
  const auto status = integrate<2>(
      RationalElements<2>({&knots[0], &knots[1]}, weights), weights.size(), a, b, tolerance, result,
      [&](int i, int j, double value) { triplets.emplace_back(i, j, value); });
  if (!status) return std::unexpected(status.error());
  result.matrix.resize(count, count);
  result.matrix.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

Expected<BandMatrix> constant_denominator_gramian(const KnotVector& knots,
                                                  std::span<const double> weights, int a, int b) {
  if (const auto good = detail::check_rational(weights, knots.count(), {a, 0}, {b, 0}, 1); !good)
    return std::unexpected(good.error());
  const int p = knots.degree(), orders[2] = {a, b}, none[1] = {0};
  BandMatrix result(knots.count(), p, detail::symmetry_of(a, b));
  const detail::UnitGaussRule<double> rule = detail::unit_gauss<double>(p + 1);
  detail::SpanValues<double> f[2], middle[1];
  for (const int span : knots.spans()) {
    detail::span_basis(knots, span, 0.5, 0.5, none, 1, middle);
    double w = 0;
    for (int r = 0; r <= p; ++r)
      w += weights[static_cast<std::size_t>(span - p + r)] * middle[0][r];
    for (std::size_t g = 0; g < rule.t.size(); ++g) {
      detail::span_basis(knots, span, rule.t[g], rule.complement[g], orders, 2, f);
      const double factor = (knots[span + 1] - knots[span]) * rule.weights[g] / (w * w);
      for (int i = 0; i <= p; ++i) {
        for (int j = a == b ? i : 0; j <= p; ++j) {
          result.at(span - p + i, span - p + j) +=
              factor * weights[static_cast<std::size_t>(span - p + i)] *
              weights[static_cast<std::size_t>(span - p + j)] * f[0][i] * f[1][j];
        }
      }
    }
  }
  return result;
}

}  // namespace knead
