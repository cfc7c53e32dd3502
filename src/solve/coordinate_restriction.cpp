#include "coordinate_restriction.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "dissection.hpp"
#include "independent_places.hpp"

namespace knead {
namespace {

// Of 16 bytes each. Conditions that tie a point to a hundred others, as those of rational creases
// of high degree, make ten thousand of an entry.
constexpr std::ptrdiff_t most_pieces = 20'000'000;

using MapRow = std::vector<std::pair<int, double>>;  // of T: unknown, coefficient

std::vector<MapRow> map_rows(const ConstraintSpace& space) {
  std::vector<int> all(static_cast<std::size_t>(space.size()));
  std::iota(all.begin(), all.end(), 0);
  std::vector<MapRow> rows(3 * all.size());
  for (const ConstraintSpace::Term& term : space.terms(all)) {
    rows[static_cast<std::size_t>(term.row)].emplace_back(term.unknown, term.coefficient);
  }
  return rows;
}

/// Calls visit(entry of A, unknown, unknown, coefficient) for all that the entries of A add to Tᵀ A
/// T.
///
/// An entry A_ij adds c d A_ij to entry (p, q) for each term (p, c) of row i of T and (q, d) of row
/// j: one term each where points are free, so that the sum is then a renumbering.
template <class Visit>
void each_restricted(const SparseMatrix& a, const std::vector<MapRow>& rows, Visit visit) {
  int entry = 0;
  for (Eigen::Index j = 0; j < a.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(a, j); it; ++it, ++entry) {
      for (const auto& [p, c] : rows[static_cast<std::size_t>(it.index())]) {
        for (const auto& [q, d] : rows[static_cast<std::size_t>(j)]) visit(entry, p, q, c * d);
      }
    }
  }
}

std::ptrdiff_t count_pieces(const SparseMatrix& a, const std::vector<MapRow>& rows) {
  std::ptrdiff_t count = 0;
  for (Eigen::Index j = 0; j < a.outerSize(); ++j) {
    std::ptrdiff_t column = 0;
    for (SparseMatrix::InnerIterator it(a, j); it; ++it)
      column += std::ssize(rows[static_cast<std::size_t>(it.index())]);
    count += column * std::ssize(rows[static_cast<std::size_t>(j)]);
  }
  return count;
}

SparseMatrix map_of(const std::vector<MapRow>& rows, int unknowns) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const auto& [p, c] : rows[i]) entries.emplace_back(static_cast<int>(i), p, c);
  }
  SparseMatrix map(std::ssize(rows), unknowns);
  map.setFromTriplets(entries.begin(), entries.end());
  return map;
}

/// Numbers that are marked once each.
struct Marks {
  explicit Marks(Eigen::Index size) : marked(static_cast<std::size_t>(size), 0) {}
  void mark(int k) {
    if (std::exchange(marked[static_cast<std::size_t>(k)], 1) == 0) list.push_back(k);
  }
  void clear() {
    for (const int k : list) marked[static_cast<std::size_t>(k)] = 0;
    list.clear();
  }
  std::vector<char> marked;
  std::vector<int> list;
};

/// Ones where Tᵀ A T has entries, column by column.
///
/// Column q of Tᵀ A T is nonzero where Tᵀ (A t_q) may be: the rows of A's columns in t_q, then the
/// unknowns of these rows. Marks take the memory of one column, whatever the number of terms.
SparseMatrix restricted_pattern(const SparseMatrix& a, const std::vector<MapRow>& rows,
                                const SparseMatrix& map) {
  SparseMatrix pattern(map.cols(), map.cols());
  pattern.reserve(a.nonZeros());
  Marks of_a(a.rows()), unknowns(map.cols());
  for (Eigen::Index q = 0; q < map.cols(); ++q) {
    of_a.clear();
    unknowns.clear();
    for (SparseMatrix::InnerIterator t(map, q); t; ++t) {
      for (SparseMatrix::InnerIterator it(a, t.index()); it; ++it)
        of_a.mark(static_cast<int>(it.index()));
    }
    for (const int i : of_a.list) {
      for (const auto& [p, c] : rows[static_cast<std::size_t>(i)]) unknowns.mark(p);
    }
    std::ranges::sort(unknowns.list);
    pattern.startVec(q);
    for (const int p : unknowns.list) pattern.insertBack(p, q) = 1;
  }
  pattern.finalize();
  return pattern;
}

}  // namespace

// A Hessian has the same pattern at every iterate, while its values change: order, pattern and the
// place of every product are found once, and `lower` is then one loop of multiply-adds.
CoordinateRestriction::CoordinateRestriction(const ConstraintSpace& space,
                                             const SparseMatrix& pattern,
                                             const GridPlaces* places) {
  assert(space.coupled() && pattern.isCompressed() && pattern.rows() == 3 * space.size());
  const std::vector<MapRow> rows = map_rows(space);
  const auto unknowns = detail::independent_places(space, places);
  map_ = map_of(rows, space.free_count());
  {
    const SparseMatrix whole = restricted_pattern(pattern, rows, map_);
    dissection_ = unknowns ? dissect(whole, *unknowns) : minimum_degree(whole);
    zero_.resize(whole.rows(), whole.cols());
    zero_.selfadjointView<Eigen::Lower>() = whole.selfadjointView<Eigen::Lower>().twistedBy(
        Eigen::PermutationMatrix<Eigen::Dynamic>(dissection_.order));
  }
  zero_.makeCompressed();
  for (Eigen::Index j = 0; j < zero_.outerSize(); ++j) {
    std::sort(zero_.innerIndexPtr() + zero_.outerIndexPtr()[j],
              zero_.innerIndexPtr() + zero_.outerIndexPtr()[j + 1]);
  }
  std::fill_n(zero_.valuePtr(), zero_.nonZeros(), 0.0);
  if (count_pieces(pattern, rows) > most_pieces) return;
  map_.resize(0, 0);
  const Eigen::VectorXi& order = dissection_.order;
  const int *start = zero_.outerIndexPtr(), *index = zero_.innerIndexPtr();
  each_restricted(pattern, rows, [&](int from, int p, int q, double coefficient) {
    const int row = order[p], column = order[q];
    if (row < column) return;  // its mirror image is visited too
    const int to = static_cast<int>(
        std::lower_bound(index + start[column], index + start[column + 1], row) - index);
    pieces_.push_back({from, to, coefficient});
  });
}

/// Column by column: A times a column of T, then the columns of T times that, where the pattern has
/// entries.
SparseMatrix CoordinateRestriction::product(const SparseMatrix& a) const {
  SparseMatrix result = zero_;
  const Eigen::VectorXi& order = dissection_.order;
  std::vector<int> unknown(static_cast<std::size_t>(order.size()));
  for (Eigen::Index p = 0; p < order.size(); ++p)
    unknown[static_cast<std::size_t>(order[p])] = static_cast<int>(p);
  Eigen::VectorXd image(a.rows());
  for (Eigen::Index column = 0; column < result.outerSize(); ++column) {
    image.setZero();
    for (SparseMatrix::InnerIterator t(map_, unknown[static_cast<std::size_t>(column)]); t; ++t) {
      for (SparseMatrix::InnerIterator it(a, t.index()); it; ++it)
        image[it.index()] += t.value() * it.value();
    }
    for (SparseMatrix::InnerIterator entry(result, column); entry; ++entry) {
      double sum = 0;
      for (SparseMatrix::InnerIterator t(map_, unknown[static_cast<std::size_t>(entry.index())]); t;
           ++t) {
        sum += t.value() * image[t.index()];
      }
      entry.valueRef() = sum;
    }
  }
  return result;
}

SparseMatrix CoordinateRestriction::lower(const SparseMatrix& a) const {
  if (map_.size() > 0) return product(a);
  SparseMatrix result = zero_;
  const double* from = a.valuePtr();
  double* to = result.valuePtr();
  for (const Piece& piece : pieces_) to[piece.to] += piece.coefficient * from[piece.from];
  return result;
}

}  // namespace knead
