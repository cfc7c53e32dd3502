#pragma once

#include <memory>

#include "knead/energy/stiffness.hpp"

namespace knead {

/// A = L Lᵀ of a sparse symmetric positive definite matrix, with a fill-reducing ordering; factor once, solve many.
class SparseCholesky {
 public:
  /// Uses the lower triangle of A. Error (numerical): A is not positive definite or not finite.
  [[nodiscard]] static Expected<SparseCholesky> factor(const SparseMatrix& a);

  /// X with A X = B, three columns at once. Cost: O(nonzeros of L). const and thread-safe.
  [[nodiscard]] Points solve(const Points& b) const;
  /// The same for one column.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

  [[nodiscard]] int size() const { return size_; }

 private:
  struct Factor;
  SparseCholesky(std::shared_ptr<const Factor> factor, int size) : factor_(std::move(factor)), size_(size) {}
  std::shared_ptr<const Factor> factor_;
  int size_;
};

}  // namespace knead
