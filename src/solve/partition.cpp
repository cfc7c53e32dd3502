#include "knead/solve/partition.hpp"

#include <cassert>

namespace knead {

Partition::Partition(std::vector<bool> fixed) : position_(fixed.size(), -1) {
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (fixed[i]) continue;
    position_[i] = static_cast<int>(free_.size());
    free_.push_back(static_cast<int>(i));
  }
}

Points Partition::gather(const Points& x) const {
  assert(x.rows() == size());
  Points result(free_count(), 3);
  for (std::size_t k = 0; k < free_.size(); ++k) result.row(static_cast<Eigen::Index>(k)) = x.row(free_[k]);
  return result;
}

Points Partition::scatter(const Points& free_rows) const {
  assert(free_rows.rows() == free_count());
  Points result = Points::Zero(size(), 3);
  for (std::size_t k = 0; k < free_.size(); ++k) result.row(free_[k]) = free_rows.row(static_cast<Eigen::Index>(k));
  return result;
}

Points Partition::free_part(Points x) const {
  assert(x.rows() == size());
  for (int i = 0; i < size(); ++i) {
    if (!is_free(i)) x.row(i).setZero();
  }
  return x;
}

SparseMatrix Partition::restrict(const SparseMatrix& matrix) const {
  assert(matrix.rows() == size() && matrix.cols() == size());
  if (free_count() == size()) return matrix;
  SparseMatrix result(free_count(), free_count());
  std::vector<int> counts(free_.size());
  for (std::size_t k = 0; k < free_.size(); ++k) {
    counts[k] = matrix.outerIndexPtr()[free_[k] + 1] - matrix.outerIndexPtr()[free_[k]];
  }
  result.reserve(counts);
  for (std::size_t k = 0; k < free_.size(); ++k) {
    for (SparseMatrix::InnerIterator it(matrix, free_[k]); it; ++it) {
      const int row = position_[static_cast<std::size_t>(it.row())];
      if (row >= 0) result.insert(row, static_cast<Eigen::Index>(k)) = it.value();
    }
  }
  result.makeCompressed();
  return result;
}

}  // namespace knead
