#include "knead/solve/sparse_cholesky.hpp"

#include <Eigen/SparseCholesky>
#include <cmath>

namespace knead {

struct SparseCholesky::Factor {
  SparseMatrix lower;     // L, columns sorted, diagonal first
  Eigen::VectorXi order;  // order[i] = place of unknown i in the reordered system
};

Expected<SparseCholesky> SparseCholesky::factor(const SparseMatrix& a) {
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower> llt;
  llt.compute(a);
  auto factor = std::make_shared<Factor>();
  if (llt.info() == Eigen::Success) {
    factor->lower = llt.matrixL();
    factor->order = llt.permutationP().indices();
  }
  // A NaN passes the sign test of the factorisation and shows in L.
  const bool finite =
      Eigen::Map<const Eigen::ArrayXd>(factor->lower.valuePtr(), factor->lower.nonZeros()).isFinite().all();
  if (llt.info() != Eigen::Success || !finite) {
    return numerical_error("the system matrix is not positive definite", "Cholesky factorisation",
                           "hold more control points, or use a larger lambda or positive material coefficients");
  }
  return SparseCholesky(std::move(factor), static_cast<int>(a.rows()));
}

namespace {

/// L y = b, Lᵀ x = y with the columns side by side: L is read once per sweep instead of once per column.
template <int columns>
void substitute(const SparseMatrix& l, double* x) {
  const auto* start = l.outerIndexPtr();
  const auto* row = l.innerIndexPtr();
  const double* value = l.valuePtr();
  const auto size = static_cast<int>(l.cols());
  for (int j = 0; j < size; ++j) {
    double* xj = x + columns * static_cast<std::ptrdiff_t>(j);
    double known[columns];
    for (int c = 0; c < columns; ++c) known[c] = xj[c] /= value[start[j]];
    for (auto k = start[j] + 1; k < start[j + 1]; ++k) {
      double* xi = x + columns * static_cast<std::ptrdiff_t>(row[k]);
      for (int c = 0; c < columns; ++c) xi[c] -= value[k] * known[c];
    }
  }
  for (int j = size; j-- > 0;) {
    double* xj = x + columns * static_cast<std::ptrdiff_t>(j);
    double sum[columns];
    for (int c = 0; c < columns; ++c) sum[c] = xj[c];
    for (auto k = start[j] + 1; k < start[j + 1]; ++k) {
      const double* xi = x + columns * static_cast<std::ptrdiff_t>(row[k]);
      for (int c = 0; c < columns; ++c) sum[c] -= value[k] * xi[c];
    }
    for (int c = 0; c < columns; ++c) xj[c] = sum[c] / value[start[j]];
  }
}

}  // namespace

Points SparseCholesky::solve(const Points& b) const {
  Points y(size_, 3), result(size_, 3);
  for (int i = 0; i < size_; ++i) y.row(factor_->order[i]) = b.row(i);
  substitute<3>(factor_->lower, y.data());
  for (int i = 0; i < size_; ++i) result.row(i) = y.row(factor_->order[i]);
  return result;
}

Eigen::VectorXd SparseCholesky::solve(const Eigen::VectorXd& b) const {
  Eigen::VectorXd y(size_), result(size_);
  for (int i = 0; i < size_; ++i) y[factor_->order[i]] = b[i];
  substitute<1>(factor_->lower, y.data());
  for (int i = 0; i < size_; ++i) result[i] = y[factor_->order[i]];
  return result;
}

}  // namespace knead
