#include "dense_decompositions.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "knead/sculpt/shape.hpp"

namespace knead {

Eigen::Quaterniond turn_between(const Point& from, const Point& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

namespace detail {

LeftSingular left_singular(const Eigen::MatrixXd& a) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU);
  return {svd.matrixU(), svd.singularValues()};
}

Eigen::MatrixXd solved(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return a.partialPivLu().solve(b); }

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

}  // namespace detail
}  // namespace knead
