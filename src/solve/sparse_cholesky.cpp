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

Points SparseCholesky::solve(const Points& b) const {
  // Substitution with the three columns side by side: L is read once per sweep instead of once per column.
  const SparseMatrix& l = factor_->lower;
  const auto* start = l.outerIndexPtr();
  const auto* row = l.innerIndexPtr();
  const double* value = l.valuePtr();
  Points y(size_, 3);
  for (int i = 0; i < size_; ++i) y.row(factor_->order[i]) = b.row(i);
  double* x = y.data();
  for (int j = 0; j < size_; ++j) {
    double* xj = x + 3 * static_cast<std::ptrdiff_t>(j);
    const double pivot = value[start[j]];
    for (int c = 0; c < 3; ++c) xj[c] /= pivot;
    const double x0 = xj[0], x1 = xj[1], x2 = xj[2];
    for (auto k = start[j] + 1; k < start[j + 1]; ++k) {
      double* xi = x + 3 * static_cast<std::ptrdiff_t>(row[k]);
      xi[0] -= value[k] * x0;
      xi[1] -= value[k] * x1;
      xi[2] -= value[k] * x2;
    }
  }
  for (int j = size_; j-- > 0;) {
    double* xj = x + 3 * static_cast<std::ptrdiff_t>(j);
    double x0 = xj[0], x1 = xj[1], x2 = xj[2];
    for (auto k = start[j] + 1; k < start[j + 1]; ++k) {
      const double* xi = x + 3 * static_cast<std::ptrdiff_t>(row[k]);
      x0 -= value[k] * xi[0];
      x1 -= value[k] * xi[1];
      x2 -= value[k] * xi[2];
    }
    const double pivot = value[start[j]];
    xj[0] = x0 / pivot;
    xj[1] = x1 / pivot;
    xj[2] = x2 / pivot;
  }
  Points result(size_, 3);
  for (int i = 0; i < size_; ++i) result.row(i) = y.row(factor_->order[i]);
  return result;
}

}  // namespace knead
