#pragma once

#include <span>
#include <vector>

#include "potential.hpp"

namespace knead {

/// Σ f N_i N_j H over Gauss points of one element with the basis functions N, H a symmetric 3 × 3
/// matrix: the products of basis functions are found once per point, for all six entries of H.
class ElementHessian {
 public:
  void begin(const std::vector<int>& rows) {
    rows_ = rows;
    pairs_ = rows.size() * (rows.size() + 1) / 2;
    products_.resize(pairs_);
    sums_.assign(6 * pairs_, 0.0);
  }
  [[nodiscard]] const std::vector<int>& rows() const { return rows_; }

  void add(std::span<const double> basis, double factor, const Eigen::Matrix3d& h) {
    double* product = products_.data();
    for (std::size_t i = 0; i < basis.size(); ++i) {
      const double share = factor * basis[i];
      for (std::size_t j = 0; j <= i; ++j) *product++ = share * basis[j];
    }
    const double entries[6] = {h(0, 0), h(1, 0), h(1, 1), h(2, 0), h(2, 1), h(2, 2)};
    for (std::size_t e = 0; e < 6; ++e) {
      double* sum = sums_.data() + e * pairs_;
      for (std::size_t k = 0; k < pairs_; ++k) sum[k] += entries[e] * products_[k];
    }
  }

  /// Calls `add_block` with the sum, unless there is none.
  void give(const AddBlock& add_block) {
    if (rows_.empty()) return;
    const auto count = static_cast<Eigen::Index>(rows_.size());
    block_.resize(3 * count, 3 * count);
    const double* sum = sums_.data();
    for (Eigen::Index c = 0; c < 3; ++c) {
      for (Eigen::Index e = 0; e <= c; ++e) {
        for (Eigen::Index i = 0; i < count; ++i) {
          for (Eigen::Index j = 0; j <= i; ++j, ++sum) {
            block_(3 * i + c, 3 * j + e) = block_(3 * j + c, 3 * i + e) = *sum;
            block_(3 * i + e, 3 * j + c) = block_(3 * j + e, 3 * i + c) = *sum;
          }
        }
      }
    }
    add_block(rows_, block_);
  }

 private:
  std::vector<int> rows_;
  std::size_t pairs_ = 0;
  std::vector<double> products_, sums_;  // of functions i >= j, for each entry of H one array
  Eigen::MatrixXd block_;
};

}  // namespace knead
