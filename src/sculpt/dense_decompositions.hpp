#pragma once

#include <Eigen/Core>
#include <memory>

namespace knead::detail {

// Eigen's dense decompositions of matrices of any size, compiled once: their templates take seconds in each file that
// names them.

/// A = U diag(values) Vᵀ without V, by Jacobi's method. Values decrease; U is rows × min(rows, columns).
struct LeftSingular {
  Eigen::MatrixXd vectors;
  Eigen::VectorXd values;
};
[[nodiscard]] LeftSingular left_singular(const Eigen::MatrixXd& a);

/// The solution of A X = B for regular square A, by LU with partial pivoting.
[[nodiscard]] Eigen::MatrixXd solved(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// A P = Q R with the columns pivoted, so that the diagonal of R decreases in absolute value.
class PivotedQr {
 public:
  explicit PivotedQr(const Eigen::MatrixXd& a);
  PivotedQr(const PivotedQr&) = delete;
  PivotedQr& operator=(const PivotedQr&) = delete;
  ~PivotedQr();

  /// The columns of A in the order of the pivots.
  [[nodiscard]] const Eigen::VectorXi& order() const;
  /// |R_kk|.
  [[nodiscard]] double pivot(Eigen::Index k) const;
  /// The remainders of the other columns after the first `rank` pivots, in pivot order. \param rank less than the
  /// numbers of rows and columns
  [[nodiscard]] Eigen::MatrixXd remainder(Eigen::Index rank) const;

 private:
  struct Factors;
  std::unique_ptr<const Factors> factors_;
};

}  // namespace knead::detail
