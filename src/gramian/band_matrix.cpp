#include "knead/gramian/band_matrix.hpp"

#include <algorithm>

namespace knead {
namespace {

constexpr std::size_t cache_line = 8;  // doubles in a cache line

/// Whole lines, one of them to spare, and an odd number of them, so that it is never a power of two
/// above a line.
std::size_t padded(int size) {
  const std::size_t lines = (static_cast<std::size_t>(size) + cache_line - 1) / cache_line + 1;
  return (lines | 1) * cache_line;
}

}  // namespace

BandMatrix::BandMatrix(int size, int half_bandwidth, BandSymmetry symmetry)
    : size_(size), half_bandwidth_(half_bandwidth), symmetry_(symmetry), stride_(padded(size)) {
  assert(size >= 0 && half_bandwidth >= 0);
  const int stored =
      symmetry == BandSymmetry::symmetric ? half_bandwidth + 1 : 2 * half_bandwidth + 1;
  data_.assign(static_cast<std::size_t>(stored) * stride_, 0.0);
}

bool BandMatrix::all_finite() const {
  for (int s = symmetry_ == BandSymmetry::symmetric ? 0 : -half_bandwidth_; s <= half_bandwidth_;
       ++s) {
    if (!std::ranges::all_of(diagonal(s), [](double x) { return std::isfinite(x); })) return false;
  }
  return true;
}

BandMatrix BandMatrix::transposed() const {
  BandMatrix result(size_, half_bandwidth_, symmetry_);
  const int lowest = symmetry_ == BandSymmetry::symmetric ? 0 : -half_bandwidth_;
  for (int s = lowest; s <= half_bandwidth_; ++s) {
    const int source = symmetry_ == BandSymmetry::symmetric ? s : -s;
    std::ranges::copy(diagonal(source), result.diagonal(s).begin());
  }
  return result;
}

Eigen::MatrixXd BandMatrix::multiply(const Eigen::Ref<const Eigen::MatrixXd>& x) const {
  assert(x.rows() == size_);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size_, x.cols());
  for (int s = -half_bandwidth_; s <= half_bandwidth_; ++s) {
    const std::span<const double> entries = diagonal(s);
    const auto length = static_cast<Eigen::Index>(entries.size());
    const Eigen::Map<const Eigen::ArrayXd> weights(entries.data(), length);
    const Eigen::Index row = std::max(0, -s), column = std::max(0, s);
    for (Eigen::Index c = 0; c < x.cols() && length > 0; ++c) {
      result.col(c).segment(row, length).array() +=
          weights * x.col(c).segment(column, length).array();
    }
  }
  return result;
}

Eigen::MatrixXd BandMatrix::dense() const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size_, size_);
  for (int i = 0; i < size_; ++i) {
    const int last = std::min(size_ - 1, i + half_bandwidth_);
    for (int j = std::max(0, i - half_bandwidth_); j <= last; ++j) result(i, j) = (*this)(i, j);
  }
  return result;
}

Eigen::SparseMatrix<double> BandMatrix::sparse() const {
  Eigen::SparseMatrix<double> result(size_, size_);
  result.reserve(Eigen::VectorXi::Constant(size_, 2 * half_bandwidth_ + 1));
  for (int j = 0; j < size_; ++j) {
    const int last = std::min(size_ - 1, j + half_bandwidth_);
    for (int i = std::max(0, j - half_bandwidth_); i <= last; ++i)
      result.insert(i, j) = (*this)(i, j);
  }
  result.makeCompressed();
  return result;
}

}  // namespace knead
