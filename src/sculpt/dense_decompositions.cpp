#include "dense_decompositions.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace knead::detail {

LeftSingular left_singular(const Eigen::Matrix3Xd& a) {
  // With the QR decomposition Aᵀ P = Q R, the left singular vectors of A = (P Rᵀ) Qᵀ are those of the small P Rᵀ.
  const Eigen::MatrixXd transposed = a.transpose();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(transposed);
  const Eigen::Index rank = std::min<Eigen::Index>(3, a.cols());
  Eigen::Matrix3d small = Eigen::Matrix3d::Zero();
  for (Eigen::Index j = 0; j < 3; ++j) {
    for (Eigen::Index i = 0; i <= std::min(j, rank - 1); ++i)
      small(qr.colsPermutation().indices()[j], i) = qr.matrixR()(i, j);
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d, Eigen::NoQRPreconditioner> svd(small, Eigen::ComputeFullU);
  return {svd.matrixU(), svd.singularValues()};
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(a).solve(b);
}

struct PivotedQr::Factors {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
};

PivotedQr::PivotedQr(const Eigen::MatrixXd& a)
    : factors_(std::make_unique<Factors>(Factors{Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(a)})) {}
PivotedQr::~PivotedQr() = default;

const Eigen::VectorXi& PivotedQr::order() const { return factors_->qr.colsPermutation().indices(); }

double PivotedQr::pivot(Eigen::Index k) const { return std::abs(factors_->qr.matrixR()(k, k)); }

Eigen::MatrixXd PivotedQr::remainder(Eigen::Index rank) const {
  const auto& r = factors_->qr.matrixR();
  const Eigen::Index most = std::min(r.rows(), r.cols()), columns = r.cols() - rank;
  Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(r.rows(), columns);
  rest.middleRows(rank, most - rank) = r.block(rank, rank, most - rank, columns).triangularView<Eigen::Upper>();
  rest.applyOnTheLeft(factors_->qr.householderQ());
  return rest;
}

Eigen::MatrixXd PivotedQr::coefficients(Eigen::Index rank) const {
  const auto& r = factors_->qr.matrixR();
  Eigen::MatrixXd others = r.topRightCorner(rank, r.cols() - rank);
  if (others.size() > 0) r.topLeftCorner(rank, rank).triangularView<Eigen::Upper>().solveInPlace(others);
  Eigen::MatrixXd result(rank, r.cols());
  for (Eigen::Index k = 0; k < r.cols(); ++k) {
    if (k < rank)
      result.col(order()[k]).setUnit(k);
    else
      result.col(order()[k]) = others.col(k - rank);
  }
  return result;
}

}  // namespace knead::detail
