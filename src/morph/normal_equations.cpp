#include "normal_equations.hpp"

#include <algorithm>

namespace knead::morph {

void NormalEquations::add(const Terms& row, double weight, const Point& value) {
  if (row.empty() || weight == 0) return;
  const bool same = std::ranges::equal(current_, row, {}, {}, &Terms::value_type::first);
  const auto n = static_cast<Eigen::Index>(row.size());
  if (!same) {
    flush();
    current_.clear();
    for (const auto& [k, c] : row) current_.push_back(k);
    block_.setZero(n, n);
    row_.resize(n);
  }
  for (Eigen::Index k = 0; k < n; ++k) row_[k] = row[static_cast<std::size_t>(k)].second;
  for (Eigen::Index j = 0; j < n; ++j) {
    if (row_[j] == 0) continue;
    const double c = weight * row_[j];
    block_.col(j).tail(n - j) += c * row_.tail(n - j);
    right_.row(row[static_cast<std::size_t>(j)].first) += c * value.transpose();
  }
}

// Of unknowns that several control points share, entries of both triangles of the block fall on the
// diagonal, and both count.
void NormalEquations::enter(int row, int column, double value) {
  if (row >= column) entries_.emplace_back(row, column, value);
}

void NormalEquations::flush() {
  for (std::size_t j = 0; j < current_.size(); ++j) {
    for (std::size_t i = j; i < current_.size(); ++i) {
      const double value = block_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      if (value == 0) continue;
      enter(current_[i], current_[j], value);
      if (i != j) enter(current_[j], current_[i], value);
    }
  }
  current_.clear();
  compress_if_many();
}

// Points of edges run through many pairs of cells, whose blocks overlap: entries of the same place
// are summed up before they take more memory than the matrix.
void NormalEquations::compress() {
  SparseMatrix part(lower_.rows(), lower_.cols());
  part.setFromTriplets(entries_.begin(), entries_.end());
  lower_ += part;
  entries_.clear();
}
void NormalEquations::compress_if_many() {
  constexpr std::size_t many = std::size_t{1} << 21;
  if (entries_.size() > many) compress();
}

void NormalEquations::add(const SparseMatrix& own, std::span<const int> unknown, double factor) {
  for (int column = 0; column < own.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator at(own, column); at; ++at) {
      enter(unknown[static_cast<std::size_t>(at.row())], unknown[static_cast<std::size_t>(column)],
            factor * at.value());
    }
  }
  compress_if_many();
}

SparseMatrix NormalEquations::matrix() {
  flush();
  compress();
  entries_ = {};
  return lower_.selfadjointView<Eigen::Lower>();
}

}  // namespace knead::morph
