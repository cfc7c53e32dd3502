#include "coordinate_restriction.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "independent_places.hpp"

namespace knead {
namespace {

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

/// Calls visit(entry of A, unknown, unknown, coefficient) for all that the entries of A add to Tᵀ A T.
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

/// Ones where Tᵀ A T has entries.
SparseMatrix restricted_pattern(const SparseMatrix& a, const std::vector<MapRow>& rows, int size) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(a.nonZeros()));
  each_restricted(a, rows, [&](int, int p, int q, double) { entries.emplace_back(p, q, 1.0); });
  SparseMatrix pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  return pattern;
}

}  // namespace

CoordinateRestriction::CoordinateRestriction(const ConstraintSpace& space, const SparseMatrix& pattern,
                                             const GridPlaces* places) {
  assert(space.coupled() && pattern.isCompressed() && pattern.rows() == 3 * space.size());
  const std::vector<MapRow> rows = map_rows(space);
  const auto unknowns = detail::independent_places(space, places);
  {
    const SparseMatrix whole = restricted_pattern(pattern, rows, space.free_count());
    dissection_ = unknowns ? dissect(whole, *unknowns) : minimum_degree(whole);
    zero_.resize(whole.rows(), whole.cols());
    zero_.selfadjointView<Eigen::Lower>() =
        whole.selfadjointView<Eigen::Lower>().twistedBy(Eigen::PermutationMatrix<Eigen::Dynamic>(dissection_.order));
  }
  zero_.makeCompressed();
  for (Eigen::Index j = 0; j < zero_.outerSize(); ++j) {
    std::sort(zero_.innerIndexPtr() + zero_.outerIndexPtr()[j], zero_.innerIndexPtr() + zero_.outerIndexPtr()[j + 1]);
  }
  std::fill_n(zero_.valuePtr(), zero_.nonZeros(), 0.0);
  const Eigen::VectorXi& order = dissection_.order;
  const int *start = zero_.outerIndexPtr(), *index = zero_.innerIndexPtr();
  each_restricted(pattern, rows, [&](int from, int p, int q, double coefficient) {
    const int row = order[p], column = order[q];
    if (row < column) return;  // its mirror image is visited too
    const int to = static_cast<int>(std::lower_bound(index + start[column], index + start[column + 1], row) - index);
    pieces_.push_back({from, to, coefficient});
  });
}

SparseMatrix CoordinateRestriction::lower(const SparseMatrix& a) const {
  SparseMatrix result = zero_;
  const double* from = a.valuePtr();
  double* to = result.valuePtr();
  for (const Piece& piece : pieces_) to[piece.to] += piece.coefficient * from[piece.from];
  return result;
}

}  // namespace knead
