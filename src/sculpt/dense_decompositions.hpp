#pragma once

#include <Eigen/Core>
#include <memory>

namespace knead::detail {

// Eigen's dense decompositions, compiled once: their templates take seconds in each file that names them.

/// The left singular vectors of A and its singular values, which decrease. Errors are a few units of rounding times the
/// largest singular value.
struct LeftSingular {
  Eigen::Matrix3d vectors;
  Eigen::Vector3d values;
};
[[nodiscard]] LeftSingular left_singular(const Eigen::Matrix3Xd& a);

/// The x that makes |A x − b| least, by a QR decomposition with pivoting. Where the columns of A are dependent, the
/// last pivots get zero.
[[nodiscard]] Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

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
  /// All columns of A as combinations of the first `rank` pivots, those of least squares: coefficients(k, j) is that of
  /// pivot k in column j of A. \param rank at most the numbers of rows and columns; its pivots are not zero
  [[nodiscard]] Eigen::MatrixXd coefficients(Eigen::Index rank) const;

 private:
  struct Factors;
  std::unique_ptr<const Factors> factors_;
};

}  // namespace knead::detail
