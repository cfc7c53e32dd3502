#include "decompositions.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace knead::detail {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// Products of two entries of any matrix that fits into memory stay finite.
constexpr int safe_exponent = 300;
constexpr double vanishing = 1e-15;

std::unexpected<Error> not_finite(Eigen::Index row, Eigen::Index column) {
  return numerical_error(
      "an entry of a matrix is not a finite number", fmt::format("({}, {})", row, column),
      "look for coordinates, weights or knots that are extremely large or small");
}

template <class Matrix>
Expected<void> check_finite(const Matrix& a) {
  if (a.allFinite()) return {};
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      if (!std::isfinite(a(i, j))) return not_finite(i, j);
    }
  }
  return {};
}

/// The power of two by which a matrix is multiplied so that squares of its entries neither overflow
/// nor vanish: 0 for all but extreme ones.
///
/// Squares overflow from 2^512 on and vanish below 2^-537: at 2^±300 a sum of squares is safe, and
/// a multiplication by a power of two changes no digit.
template <class Matrix>
int exponent_of(const Matrix& a) {
  const double largest = a.size() > 0 ? a.cwiseAbs().maxCoeff() : 0;
  if (largest == 0) return 0;
  const int exponent = std::ilogb(largest);
  return std::abs(exponent) > safe_exponent ? -exponent : 0;
}

template <class Matrix>
Matrix scaled(const Matrix& a, int exponent) {
  if (exponent == 0) return a;
  return a.unaryExpr([exponent](double x) { return std::ldexp(x, exponent); });
}

template <class Matrix, class Vector>
auto by_least_squares(const Matrix& a, const Vector& b)
    -> Expected<Eigen::Matrix<double, Matrix::ColsAtCompileTime, 1>> {
  if (auto finite = check_finite(a); !finite) return std::unexpected(finite.error());
  if (auto finite = check_finite(b); !finite) return std::unexpected(finite.error());
  using Result = Eigen::Matrix<double, Matrix::ColsAtCompileTime, 1>;
  Result x = Result::Zero(a.cols());
  if (a.size() == 0) return x;
  const int of_a = exponent_of(a), of_b = exponent_of(b);
  x = Eigen::ColPivHouseholderQR<Matrix>(scaled(a, of_a)).solve(scaled(b, of_b));
  return scaled(x, of_a - of_b);
}

}  // namespace

// A is 3 × n with n up to a row of a net. Its singular values by those of AAᵀ would lose half the
// digits, and an SVD of A costs more and forms vectors of length n: QR first, then Jacobi's method
// on 3 × 3.
Expected<LeftSingular> left_singular(const Eigen::Matrix3Xd& a) {
  if (auto finite = check_finite(a); !finite) return std::unexpected(finite.error());
  if (a.cols() == 0) return LeftSingular{Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
  const int exponent = exponent_of(a);
  // With the QR decomposition Aᵀ P = Q R, the left singular vectors of A = (P Rᵀ) Qᵀ are those of
  // the small P Rᵀ.
  const Eigen::MatrixXd transposed = scaled(a, exponent).transpose();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(transposed);
  const Eigen::Index rank = std::min<Eigen::Index>(3, a.cols());
  Eigen::Matrix3d small = Eigen::Matrix3d::Zero();
  for (Eigen::Index j = 0; j < 3; ++j) {
    for (Eigen::Index i = 0; i <= std::min(j, rank - 1); ++i)
      small(qr.colsPermutation().indices()[j], i) = qr.matrixR()(i, j);
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d, Eigen::NoQRPreconditioner> svd(small,
                                                                         Eigen::ComputeFullU);
  return LeftSingular{svd.matrixU(), scaled(Eigen::Vector3d(svd.singularValues()), -exponent)};
}

Expected<Eigen::VectorXd> least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return by_least_squares(a, b);
}

Expected<Eigen::Vector2d> least_squares(const Eigen::Matrix<double, 3, 2>& a,
                                        const Eigen::Vector3d& b) {
  return by_least_squares(a, b);
}

struct PivotedQr::Factors {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  Eigen::Index pivots;
  Eigen::VectorXi order;
  Eigen::MatrixXd r;  // of A itself, what lies below the diagonal being of Q
};

PivotedQr::PivotedQr(std::unique_ptr<const Factors> factors) : factors_(std::move(factors)) {}
PivotedQr::PivotedQr(PivotedQr&&) noexcept = default;
PivotedQr& PivotedQr::operator=(PivotedQr&&) noexcept = default;
PivotedQr::~PivotedQr() = default;

Expected<PivotedQr> PivotedQr::create(const Eigen::MatrixXd& a) {
  if (auto finite = check_finite(a); !finite) return std::unexpected(finite.error());
  Factors factors{{}, std::min(a.rows(), a.cols()), {}, a};
  if (factors.pivots == 0) {
    factors.order.setLinSpaced(a.cols(), 0, static_cast<int>(a.cols()) - 1);
  } else {
    const int exponent = exponent_of(a);
    factors.qr.compute(scaled(a, exponent));
    factors.order = factors.qr.colsPermutation().indices();
    factors.r = scaled(factors.qr.matrixR(), -exponent);
  }
  return PivotedQr(std::make_unique<const Factors>(std::move(factors)));
}

Eigen::Index PivotedQr::pivots() const { return factors_->pivots; }

const Eigen::VectorXi& PivotedQr::order() const { return factors_->order; }

double PivotedQr::pivot(Eigen::Index k) const { return std::abs(factors_->r(k, k)); }

// Q times the trailing block of R: what is left of each column after projection onto the pivots'
// span, in the rows of A.
Eigen::MatrixXd PivotedQr::remainder(Eigen::Index rank) const {
  const Eigen::MatrixXd& r = factors_->r;
  const Eigen::Index most = pivots(), columns = r.cols() - rank;
  Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(r.rows(), columns);
  if (rank >= most) return rest;
  rest.middleRows(rank, most - rank) =
      r.block(rank, rank, most - rank, columns).triangularView<Eigen::Upper>();
  rest.applyOnTheLeft(factors_->qr.householderQ());
  return rest;
}

// R₁₁ X = R₁₂ by substitution; the pivots themselves get unit vectors, exactly.
Eigen::MatrixXd PivotedQr::coefficients(Eigen::Index rank) const {
  const Eigen::MatrixXd& r = factors_->r;
  Eigen::MatrixXd others = r.topRightCorner(rank, r.cols() - rank);
  if (others.size() > 0)
    r.topLeftCorner(rank, rank).triangularView<Eigen::Upper>().solveInPlace(others);
  Eigen::MatrixXd result(rank, r.cols());
  for (Eigen::Index k = 0; k < r.cols(); ++k) {
    if (k < rank)
      result.col(order()[k]).setUnit(k);
    else
      result.col(order()[k]) = others.col(k - rank);
  }
  return result;
}

Expected<Eigen::MatrixXd> solve_square(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (auto finite = check_finite(a); !finite) return std::unexpected(finite.error());
  if (auto finite = check_finite(b); !finite) return std::unexpected(finite.error());
  if (a.size() == 0) return Eigen::MatrixXd(0, b.cols());
  Eigen::MatrixXd x = a.partialPivLu().solve(b);
  if (!x.allFinite()) return numerical_error("a system of equations is singular", "elimination");
  return x;
}

Expected<int> rank_of(const Eigen::Matrix3d& a) {
  if (auto finite = check_finite(a); !finite) return std::unexpected(finite.error());
  return static_cast<int>(Eigen::FullPivLU<Eigen::Matrix3d>(scaled(a, exponent_of(a))).rank());
}

template <class Matrix>
Expected<SymmetricEigen<Matrix>> symmetric_eigen(const Matrix& a) {
  if (auto finite = check_finite(a); !finite) return std::unexpected(finite.error());
  if (a.size() == 0) return SymmetricEigen<Matrix>{{}, a};
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(a);  // scales by itself
  if (solver.info() != Eigen::Success)
    return numerical_error("the iteration for eigenvalues did not end", "matrix");
  return SymmetricEigen<Matrix>{solver.eigenvalues(), solver.eigenvectors()};
}

template Expected<SymmetricEigen<Matrix1d>> symmetric_eigen(const Matrix1d&);
template Expected<SymmetricEigen<Eigen::Matrix2d>> symmetric_eigen(const Eigen::Matrix2d&);
template Expected<SymmetricEigen<Eigen::Matrix3d>> symmetric_eigen(const Eigen::Matrix3d&);
template Expected<SymmetricEigen<Eigen::MatrixXd>> symmetric_eigen(const Eigen::MatrixXd&);

Expected<Eigen::Vector3d> symmetric_eigenvalues(const Eigen::Matrix3d& a) {
  if (auto finite = check_finite(a); !finite) return std::unexpected(finite.error());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(a, Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success)
    return numerical_error("the iteration for eigenvalues did not end", "matrix");
  return solver.eigenvalues();
}

struct DenseCholesky::Factors {
  Eigen::LLT<Eigen::MatrixXd> llt;
};

DenseCholesky::DenseCholesky(std::shared_ptr<const Factors> factors)
    : factors_(std::move(factors)) {}

Expected<DenseCholesky> DenseCholesky::factor(const Eigen::MatrixXd& a) {
  if (auto finite = check_finite(a); !finite) return std::unexpected(finite.error());
  Factors factors;
  if (a.size() > 0) factors.llt.compute(a);
  if (a.size() > 0 && factors.llt.info() != Eigen::Success) {
    return numerical_error("a matrix is not positive definite", "Cholesky factorisation");
  }
  return DenseCholesky(std::make_shared<const Factors>(std::move(factors)));
}

Eigen::MatrixXd DenseCholesky::solve(const Eigen::MatrixXd& b) const {
  if (b.size() == 0) return b;
  return factors_->llt.solve(b);
}

struct SparseLdlt::Factors {
  Eigen::SimplicialLDLT<Sparse> ldlt;
  std::vector<int> starts, rows;  // of the pattern for which the order was found
  double least = 1, least_magnitude = 1;

  [[nodiscard]] bool knows(const Sparse& a) const {
    return std::ranges::equal(
               starts, std::span(a.outerIndexPtr(), static_cast<std::size_t>(a.cols() + 1))) &&
           std::ranges::equal(rows,
                              std::span(a.innerIndexPtr(), static_cast<std::size_t>(a.nonZeros())));
  }
};

SparseLdlt::SparseLdlt() : factors_(std::make_unique<Factors>()) {}
SparseLdlt::SparseLdlt(SparseLdlt&&) noexcept = default;
SparseLdlt& SparseLdlt::operator=(SparseLdlt&&) noexcept = default;
SparseLdlt::~SparseLdlt() = default;

// The order of elimination is kept while the pattern stays the same, bit by bit: a comparison of
// indices is far cheaper than minimum degree. No pivoting: an indefinite matrix may lose digits to
// growth, which the ratio of the pivots (`regular`) shows where a pivot nearly vanishes.
Expected<void> SparseLdlt::factor(const Sparse& given) {
  Sparse a = given;
  a.makeCompressed();
  for (Eigen::Index j = 0; j < a.outerSize(); ++j) {
    for (Sparse::InnerIterator it(a, j); it; ++it) {
      if (!std::isfinite(it.value())) return not_finite(it.row(), j);
    }
  }
  auto& [ldlt, starts, rows, least, least_magnitude] = *factors_;
  least = least_magnitude = 1;
  if (a.size() == 0) return {};
  if (!factors_->knows(a)) {
    ldlt.analyzePattern(a);
    starts.assign(a.outerIndexPtr(), a.outerIndexPtr() + a.cols() + 1);
    rows.assign(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros());
  }
  ldlt.factorize(a);
  if (ldlt.info() != Eigen::Success) return numerical_error("a pivot is zero", "factorisation");
  const Eigen::ArrayXd pivots = ldlt.vectorD();
  const double largest = pivots.abs().maxCoeff();
  if (!std::isfinite(largest)) return numerical_error("a pivot is not finite", "factorisation");
  least = pivots.minCoeff() / largest;
  least_magnitude = pivots.abs().minCoeff() / largest;
  return {};
}

bool SparseLdlt::regular() const { return factors_->least_magnitude > vanishing; }

bool SparseLdlt::positive() const { return factors_->least > vanishing; }

Eigen::MatrixXd SparseLdlt::solve(const Eigen::MatrixXd& b) const {
  if (b.size() == 0) return b;
  return factors_->ldlt.solve(b);
}

Eigen::VectorXd SparseLdlt::solve(const Eigen::VectorXd& b) const {
  if (b.size() == 0) return b;
  return factors_->ldlt.solve(b);
}

}  // namespace knead::detail
