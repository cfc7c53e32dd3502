#include "knead/gramian/triple_gramian.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "piece_basis.hpp"
#include "pieces.hpp"

namespace knead {
namespace detail {

// The intervals between neighbours of the union of both sets of knots, by merging: on each, the
// functions of both knot vectors are polynomials, which is what makes Gauss rules exact.
Expected<std::vector<Piece>> common_pieces(const KnotVector& first, const KnotVector& second) {
  const Interval a = first.domain(), b = second.domain();
  if (a.lower != b.lower || a.upper != b.upper) {
    return input_error(
        fmt::format("the domains [{}, {}] and [{}, {}] differ", a.lower, a.upper, b.lower, b.upper),
        {}, "give two knot vectors of one domain");
  }
  std::vector<Piece> pieces;
  const std::vector<int> first_spans = first.spans(), second_spans = second.spans();
  double lower = a.lower;
  for (std::size_t k = 0, l = 0; k < first_spans.size() && l < second_spans.size();) {
    const double upper_first = first[first_spans[k] + 1],
                 upper_second = second[second_spans[l] + 1];
    const double upper = std::min(upper_first, upper_second);
    pieces.push_back({lower, upper, first_spans[k], second_spans[l]});
    if (upper_first == upper) ++k;
    if (upper_second == upper) ++l;
    lower = upper;
  }
  return pieces;
}

const PieceKernels& piece_kernels(InstructionSet set) {
  return avx2_piece_kernels != nullptr && set >= InstructionSet::avx2 ? *avx2_piece_kernels
                                                                      : *vector128_piece_kernels;
}

}  // namespace detail

namespace {

// Above this everything is zero anyway; keeps sums of orders in range.
constexpr int max_order = 2 * max_degree;

// n points of Gauss are exact to degree 2 n − 1: ⌊d / 2⌋ + 1 are the fewest for a product of degree
// d, from which derivatives take a + b.
Expected<int> points_for(int degree, int a, int b) {
  if (a < 0 || b < 0 || a > max_order || b > max_order) {
    return usage_error(fmt::format("there are no derivatives of orders {} and {}", a, b), {},
                       fmt::format("use 0 to {}", max_order));
  }
  return std::max(0, degree - a - b) / 2 + 1;
}

using Numbers = std::vector<double>;

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

namespace {

/// The content of a triple Gramian while it is made: for each entry of the band of N_i and N_j, row
/// by row, the first coefficient function and where the values begin.
/// The functions M_k that overlap a pair follow one another, at most p + 1 − |i − j| + q on the
/// same knots: a run with its first index needs neither an index per value nor a cube of zeros.
struct Runs {
  int size, degree;
  std::vector<int> first = {};
  std::vector<std::size_t> offset = {};
  Numbers values = {};

  /// The coefficient functions that overlap each pair, with integrals of zero.
  Runs(const KnotVector& knots, int coefficient_degree, const std::vector<detail::Piece>& pieces)
      : size(knots.count()), degree(knots.degree()) {
    const std::size_t entries =
        static_cast<std::size_t>(size) * static_cast<std::size_t>(2 * degree + 1);
    std::vector<int> last(entries, -1);
    first.assign(entries, 0);
    for (const detail::Piece& piece : pieces) {
      for (int i = piece.first_span - degree; i <= piece.first_span; ++i) {
        for (int j = piece.first_span - degree; j <= piece.first_span; ++j) {
          const std::size_t at = entry(i, j);
          if (last[at] < 0) first[at] = piece.second_span - coefficient_degree;
          last[at] = piece.second_span;
        }
      }
    }
    offset.assign(entries + 1, 0);
    for (std::size_t at = 0; at < entries; ++at) {
      offset[at + 1] =
          offset[at] + (last[at] < 0 ? 0 : static_cast<std::size_t>(last[at] - first[at] + 1));
    }
    values.assign(offset.back(), 0.0);
  }

  [[nodiscard]] std::size_t entry(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(2 * degree + 1) +
           static_cast<std::size_t>(j - i + degree);
  }

  /// Where the integral of function k with N_i and N_j is.
  [[nodiscard]] double* value(int i, int j, int k) {
    const std::size_t at = entry(i, j);
    return values.data() + offset[at] + (k - first[at]);
  }

  /// The lower half is the upper one.
  void mirror() {
    for (int i = 0; i < size; ++i) {
      for (int j = i + 1; j <= std::min(size - 1, i + degree); ++j) {
        const std::size_t at = entry(i, j);
        std::copy_n(values.data() + offset[at], offset[at + 1] - offset[at],
                    values.data() + offset[entry(j, i)]);
      }
    }
  }
};

}  // namespace

// T_kij = ∫ M_k N_i^(a) N_j^(b) dt, for all k, i, j whose functions overlap: a field Σ c_k M_k
// weights a Gramian by one contraction, with no quadrature. Piece by piece: products of N_i and N_j
// at the Gauss points, weighted, times the values of M_k. For equal orders only j ≥ i, and the rest
// is copied. Cost of a piece with n points: n (p + 1)² (q + 1) multiplications, half of them for
// equal orders.
Expected<TripleGramian> triple_gramian(const KnotVector& coefficient_knots, const KnotVector& knots,
                                       int a, int b) {
  const int p = knots.degree(), q = coefficient_knots.degree();
  const Expected<int> count = points_for(2 * p + q, a, b);
  if (!count) return std::unexpected(count.error());
  const auto pieces = detail::common_pieces(knots, coefficient_knots);
  if (!pieces) return std::unexpected(pieces.error());

  Runs runs(knots, q, *pieces);
  const detail::PieceKernels& kernels = detail::piece_kernels();
  const detail::PiecePoints points(*count);
  const std::ptrdiff_t n = points.padded();
  detail::PieceBasis f(knots, a, points, kernels), other(knots, b, points, kernels),
      c(coefficient_knots, 0, points, kernels);
  const detail::PieceBasis& g = a == b ? f : other;
  const auto functions = static_cast<std::size_t>(p + 1), pairs = functions * functions;
  Numbers weighted(functions * points.t.size()), products(pairs * points.t.size());
  std::vector<double*> to(pairs);
  for (const detail::Piece& piece : *pieces) {
    f.enter(piece.first_span, piece.lower, piece.upper);
    if (a != b) other.enter(piece.first_span, piece.lower, piece.upper);
    c.enter(piece.second_span, piece.lower, piece.upper);
    kernels.weigh(piece.upper - piece.lower, points.weights.data(), f.values(), p + 1, n,
                  weighted.data());
    kernels.multiply(weighted.data(), g.values(), p + 1, a == b, n, products.data());
    const int first = piece.first_span - p;
    std::size_t pair = 0;
    for (int i = 0; i <= p; ++i) {
      for (int j = a == b ? i : 0; j <= p; ++j)
        to[pair++] = runs.value(first + i, first + j, piece.second_span - q);
    }
    kernels.accumulate(products.data(), static_cast<std::ptrdiff_t>(pair), n, points.count,
                       c.by_points(), q + 1, c.width(), to.data());
  }
  if (a == b) runs.mirror();

  TripleGramian result;
  result.size_ = runs.size;
  result.degree_ = p;
  result.coefficient_count_ = coefficient_knots.count();
  result.symmetric_ = a == b;
  result.first_ = std::move(runs.first);
  result.offset_ = std::move(runs.offset);
  result.values_ = std::move(runs.values);
  return result;
}

namespace {

/// A matrix of zeros: in column j the rows whose functions share a piece with it, which follow one
/// another.
Eigen::SparseMatrix<double> overlapping(const KnotVector& rows, const KnotVector& columns,
                                        const std::vector<detail::Piece>& pieces) {
  const int p = rows.degree(), q = columns.degree();
  std::vector<int> first(static_cast<std::size_t>(columns.count()), 0), end(first);
  for (const detail::Piece& piece : pieces) {
    for (int j = piece.second_span - q; j <= piece.second_span; ++j) {
      const auto at = static_cast<std::size_t>(j);
      if (end[at] == 0) first[at] = piece.first_span - p;
      end[at] = piece.first_span + 1;
    }
  }
  Eigen::SparseMatrix<double> result(rows.count(), columns.count());
  int* outer = result.outerIndexPtr();
  for (std::size_t j = 0; j < first.size(); ++j) outer[j + 1] = outer[j] + end[j] - first[j];
  result.resizeNonZeros(outer[first.size()]);
  for (std::size_t j = 0; j < first.size(); ++j) {
    for (int k = outer[j]; k < outer[j + 1]; ++k)
      result.innerIndexPtr()[k] = first[j] + k - outer[j];
  }
  std::fill_n(result.valuePtr(), result.nonZeros(), 0.0);
  return result;
}

}  // namespace

// ∫ F_i^(a) G_j^(b) dt of two knot vectors of one domain, as a projection from one to the other
// needs; exact on their common pieces. The pattern is known from the pieces, so values are added in
// place, columns being runs of rows.
Expected<Eigen::SparseMatrix<double>> mixed_gramian(const KnotVector& rows, int a,
                                                    const KnotVector& columns, int b) {
  const int p = rows.degree(), q = columns.degree();
  const Expected<int> count = points_for(p + q, a, b);
  if (!count) return std::unexpected(count.error());
  const auto pieces = detail::common_pieces(rows, columns);
  if (!pieces) return std::unexpected(pieces.error());
  Eigen::SparseMatrix<double> result = overlapping(rows, columns, *pieces);
  const detail::PieceKernels& kernels = detail::piece_kernels();
  const detail::PiecePoints points(*count);
  const std::ptrdiff_t n = points.padded();
  detail::PieceBasis f(rows, a, points, kernels), g(columns, b, points, kernels);
  Numbers weighted(static_cast<std::size_t>(q + 1) * points.t.size());
  std::vector<double*> to(static_cast<std::size_t>(q + 1));
  for (const detail::Piece& piece : *pieces) {
    f.enter(piece.first_span, piece.lower, piece.upper);
    g.enter(piece.second_span, piece.lower, piece.upper);
    kernels.weigh(piece.upper - piece.lower, points.weights.data(), g.values(), q + 1, n,
                  weighted.data());
    const int row = piece.first_span - p, column = piece.second_span - q;
    for (int j = 0; j <= q; ++j) {
      const int begin = result.outerIndexPtr()[column + j];
      to[static_cast<std::size_t>(j)] =
          result.valuePtr() + begin + (row - result.innerIndexPtr()[begin]);
    }
    kernels.accumulate(weighted.data(), q + 1, n, points.count, f.by_points(), p + 1, f.width(),
                       to.data());
  }
  return result;
}

}  // namespace knead
