#include "knead/gramian/triple_gramian.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pieces.hpp"
#include "span_basis.hpp"
#include "unit_gauss.hpp"

namespace knead {
namespace detail {

Expected<std::vector<Piece>> common_pieces(const KnotVector& first, const KnotVector& second) {
  const Interval a = first.domain(), b = second.domain();
  if (a.lower != b.lower || a.upper != b.upper) {
    return input_error(fmt::format("the domains [{}, {}] and [{}, {}] differ", a.lower, a.upper, b.lower, b.upper), {},
                       "give two knot vectors of one domain");
  }
  std::vector<Piece> pieces;
  const std::vector<int> first_spans = first.spans(), second_spans = second.spans();
  double lower = a.lower;
  for (std::size_t k = 0, l = 0; k < first_spans.size() && l < second_spans.size();) {
    const double upper_first = first[first_spans[k] + 1], upper_second = second[second_spans[l] + 1];
    const double upper = std::min(upper_first, upper_second);
    pieces.push_back({lower, upper, first_spans[k], second_spans[l]});
    if (upper_first == upper) ++k;
    if (upper_second == upper) ++l;
    lower = upper;
  }
  return pieces;
}

}  // namespace detail

namespace {

constexpr int max_order = 2 * max_degree;  // above this everything is zero anyway; keeps sums of orders in range

Expected<int> points_for(int degree, int a, int b) {
  if (a < 0 || b < 0 || a > max_order || b > max_order) {
    return usage_error(fmt::format("there are no derivatives of orders {} and {}", a, b), {},
                       fmt::format("use 0 to {}", max_order));
  }
  return std::max(0, degree - a - b) / 2 + 1;
}

}  // namespace

double TripleGramian::operator()(int k, int i, int j) const {
  if (i - j > degree_ || j - i > degree_) return 0;
  const Run at = run(i, j);
  return k < at.first || k - at.first >= static_cast<int>(at.values.size())
             ? 0
             : at.values[static_cast<std::size_t>(k - at.first)];
}

TripleGramian::Run TripleGramian::run(int i, int j) const {
  const std::size_t at = entry(i, j);
  return {first_[at], std::span(values_).subspan(offset_[at], offset_[at + 1] - offset_[at])};
}

BandMatrix TripleGramian::contract(std::span<const double> coefficients) const {
  assert(static_cast<int>(coefficients.size()) == coefficient_count_);
  BandMatrix result(size_, degree_, symmetric_ ? BandSymmetry::symmetric : BandSymmetry::general);
  for (int i = 0; i < size_; ++i) {
    const int last = std::min(size_ - 1, i + degree_);
    for (int j = symmetric_ ? i : std::max(0, i - degree_); j <= last; ++j) {
      const Run at = run(i, j);
      double sum = 0;
      for (std::size_t r = 0; r < at.values.size(); ++r) {
        sum += coefficients[static_cast<std::size_t>(at.first) + r] * at.values[r];
      }
      result.at(i, j) = sum;
    }
  }
  return result;
}

Expected<TripleGramian> triple_gramian(const KnotVector& coefficient_knots, const KnotVector& knots, int a, int b) {
  const int p = knots.degree(), q = coefficient_knots.degree(), n = knots.count();
  const Expected<int> points = points_for(2 * p + q, a, b);
  if (!points) return std::unexpected(points.error());
  const auto pieces = detail::common_pieces(knots, coefficient_knots);
  if (!pieces) return std::unexpected(pieces.error());

  TripleGramian result;
  result.size_ = n;
  result.degree_ = p;
  result.coefficient_count_ = coefficient_knots.count();
  result.symmetric_ = a == b;
  // First the coefficient functions that overlap each pair, then their integrals.
  const std::size_t entries = static_cast<std::size_t>(n) * static_cast<std::size_t>(2 * p + 1);
  std::vector<int> last(entries, -1);
  result.first_.assign(entries, 0);
  for (const detail::Piece& piece : *pieces) {
    for (int i = piece.first_span - p; i <= piece.first_span; ++i) {
      for (int j = piece.first_span - p; j <= piece.first_span; ++j) {
        const std::size_t at = result.entry(i, j);
        if (last[at] < 0) result.first_[at] = piece.second_span - q;
        last[at] = piece.second_span;
      }
    }
  }
  result.offset_.assign(entries + 1, 0);
  for (std::size_t at = 0; at < entries; ++at) {
    result.offset_[at + 1] =
        result.offset_[at] + (last[at] < 0 ? 0 : static_cast<std::size_t>(last[at] - result.first_[at] + 1));
  }
  result.values_.assign(result.offset_.back(), 0.0);

  const detail::UnitGaussRule<double> rule = detail::unit_gauss<double>(*points);
  const int orders[2] = {a, b}, none[1] = {0};
  detail::SpanValues<double> f[2], c[1];
  for (const detail::Piece& piece : *pieces) {
    for (std::size_t g = 0; g < rule.t.size(); ++g) {
      const double t = rule.t[g], complement = rule.complement[g];
      detail::span_basis(knots, piece.first_span, piece.lower, piece.upper, t, complement, orders, 2, f);
      detail::span_basis(coefficient_knots, piece.second_span, piece.lower, piece.upper, t, complement, none, 1, c);
      const double weight = (piece.upper - piece.lower) * rule.weights[g];
      for (int i = 0; i <= p; ++i) {
        for (int j = 0; j <= p; ++j) {
          const double factor = weight * f[0][i] * f[1][j];
          const std::size_t at = result.entry(piece.first_span - p + i, piece.first_span - p + j);
          double* values = result.values_.data() + result.offset_[at] + (piece.second_span - q - result.first_[at]);
          for (int k = 0; k <= q; ++k) values[k] += factor * c[0][k];
        }
      }
    }
  }
  return result;
}

Expected<Eigen::SparseMatrix<double>> mixed_gramian(const KnotVector& rows, int a, const KnotVector& columns, int b) {
  const int p = rows.degree(), q = columns.degree();
  const Expected<int> points = points_for(p + q, a, b);
  if (!points) return std::unexpected(points.error());
  const auto pieces = detail::common_pieces(rows, columns);
  if (!pieces) return std::unexpected(pieces.error());
  const detail::UnitGaussRule<double> rule = detail::unit_gauss<double>(*points);
  detail::SpanValues<double> f[1], g[1];
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(pieces->size() * static_cast<std::size_t>((p + 1) * (q + 1)));
  for (const detail::Piece& piece : *pieces) {
    double local[max_degree + 1][max_degree + 1] = {};
    for (std::size_t k = 0; k < rule.t.size(); ++k) {
      const double t = rule.t[k], complement = rule.complement[k];
      detail::span_basis(rows, piece.first_span, piece.lower, piece.upper, t, complement, &a, 1, f);
      detail::span_basis(columns, piece.second_span, piece.lower, piece.upper, t, complement, &b, 1, g);
      const double weight = (piece.upper - piece.lower) * rule.weights[k];
      for (int i = 0; i <= p; ++i) {
        for (int j = 0; j <= q; ++j) local[i][j] += weight * f[0][i] * g[0][j];
      }
    }
    for (int i = 0; i <= p; ++i) {
      for (int j = 0; j <= q; ++j)
        triplets.emplace_back(piece.first_span - p + i, piece.second_span - q + j, local[i][j]);
    }
  }
  Eigen::SparseMatrix<double> result(rows.count(), columns.count());
  result.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

}  // namespace knead
