#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>

#include "knead/base/error.hpp"

namespace knead::detail {

// The only file that names Eigen's decompositions. They are undefined for empty matrices and for
// numbers that are not finite, lose everything where squares of entries overflow or underflow, and
// take seconds to compile in each file that names them.
//
// Here every matrix of finite numbers is decomposed: an empty one has rank 0, a rank-deficient one
// has the rank that its pivots show, and entries beyond 2^±300 are first multiplied by a power of
// two, which keeps all digits. Other matrices give the same bits as Eigen's. Errors (numerical): an
// entry that is not a finite number, with its place; the further ones that are named.

/// The left singular vectors of A and its singular values, which decrease. Of a matrix without
/// columns: the unit vectors and zeros. Errors are a few units of rounding times the largest
/// singular value.
struct LeftSingular {
  Eigen::Matrix3d vectors;
  Eigen::Vector3d values;
};
[[nodiscard]] Expected<LeftSingular> left_singular(const Eigen::Matrix3Xd& a);

/// The x that makes |A x − b| least, by a QR decomposition with pivoting. Where the columns of A
/// are dependent, the last pivots get zero.
[[nodiscard]] Expected<Eigen::VectorXd> least_squares(const Eigen::MatrixXd& a,
                                                      const Eigen::VectorXd& b);
[[nodiscard]] Expected<Eigen::Vector2d> least_squares(const Eigen::Matrix<double, 3, 2>& a,
                                                      const Eigen::Vector3d& b);

/// A P = Q R with the columns pivoted, so that the diagonal of R decreases in absolute value.
class PivotedQr {
 public:
  [[nodiscard]] static Expected<PivotedQr> create(const Eigen::MatrixXd& a);
  PivotedQr(PivotedQr&&) noexcept;
  PivotedQr& operator=(PivotedQr&&) noexcept;
  ~PivotedQr();

  /// The smaller of the numbers of rows and columns: how many pivots there are, zeros among them.
  [[nodiscard]] Eigen::Index pivots() const;
  /// The columns of A in the order of the pivots.
  [[nodiscard]] const Eigen::VectorXi& order() const;
  /// |R_kk|.
  /// \param k less than `pivots()`
  [[nodiscard]] double pivot(Eigen::Index k) const;
  /// The remainders of the other columns after the first `rank` pivots, in pivot order.
  /// \param rank at most `pivots()`
  [[nodiscard]] Eigen::MatrixXd remainder(Eigen::Index rank) const;
  /// All columns of A as combinations of the first `rank` pivots, those of least squares:
  /// coefficients(k, j) is that of pivot k in column j of A.
  /// \param rank at most `pivots()`; the pivots before it are not zero
  [[nodiscard]] Eigen::MatrixXd coefficients(Eigen::Index rank) const;

 private:
  struct Factors;
  explicit PivotedQr(std::unique_ptr<const Factors> factors);
  std::unique_ptr<const Factors> factors_;
};

/// The X of A X = B by Gaussian elimination with partial pivoting, A square. Errors (numerical): A
/// is singular, to the last bit or so far that X is not finite.
[[nodiscard]] Expected<Eigen::MatrixXd> solve_square(const Eigen::MatrixXd& a,
                                                     const Eigen::MatrixXd& b);

/// The number of pivots of A above 3 ε times the largest, with full pivoting.
[[nodiscard]] Expected<int> rank_of(const Eigen::Matrix3d& a);

/// A symmetric matrix's eigenvalues, which increase, and orthonormal eigenvectors, one per column;
/// the lower triangle is read.
template <class Matrix>
struct SymmetricEigen {
  Eigen::Matrix<double, Matrix::RowsAtCompileTime, 1> values;
  Matrix vectors;
};
/// Further error (numerical): the iteration did not end.
template <class Matrix>
[[nodiscard]] Expected<SymmetricEigen<Matrix>> symmetric_eigen(const Matrix& a);
/// The eigenvalues alone, which increase.
[[nodiscard]] Expected<Eigen::Vector3d> symmetric_eigenvalues(const Eigen::Matrix3d& a);

using Matrix1d = Eigen::Matrix<double, 1, 1>;
extern template Expected<SymmetricEigen<Matrix1d>> symmetric_eigen(const Matrix1d&);
extern template Expected<SymmetricEigen<Eigen::Matrix2d>> symmetric_eigen(const Eigen::Matrix2d&);
extern template Expected<SymmetricEigen<Eigen::Matrix3d>> symmetric_eigen(const Eigen::Matrix3d&);
extern template Expected<SymmetricEigen<Eigen::MatrixXd>> symmetric_eigen(const Eigen::MatrixXd&);

/// A = L Lᵀ of a dense symmetric positive definite matrix.
class DenseCholesky {
 public:
  /// Further error (numerical): not positive definite.
  [[nodiscard]] static Expected<DenseCholesky> factor(const Eigen::MatrixXd& a);
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

 private:
  struct Factors;
  explicit DenseCholesky(std::shared_ptr<const Factors> factors);
  std::shared_ptr<const Factors> factors_;
};

/// A = L D Lᵀ of a sparse symmetric matrix, which may be indefinite, without pivoting.
class SparseLdlt {
 public:
  SparseLdlt();
  SparseLdlt(SparseLdlt&&) noexcept;
  SparseLdlt& operator=(SparseLdlt&&) noexcept;
  ~SparseLdlt();

  /// Factors a matrix. The order of elimination is found once for all matrices of one pattern that
  /// follow each other. Further error (numerical): a pivot is zero.
  [[nodiscard]] Expected<void> factor(const Eigen::SparseMatrix<double>& a);
  /// Whether all pivots of the last factor are above 1e-15 of the largest in absolute value: no
  /// motion costs nothing.
  [[nodiscard]] bool regular() const;
  /// Whether they are positive besides.
  [[nodiscard]] bool positive() const;
  /// A⁻¹ B for the last factor.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace knead::detail
