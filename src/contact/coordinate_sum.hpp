#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <utility>
#include <vector>

#include "knead/energy/stiffness.hpp"

namespace knead {

/// A symmetric matrix over the coordinates of points plus blocks between some of them. Its pattern
/// is kept from one sum to the next and grows where a block needs more.
class CoordinateSum {
 public:
  /// \param base over all coordinates, 3 i + c being coordinate c of point i.
  explicit CoordinateSum(SparseMatrix base);

  /// The base alone again.
  void clear() { sum_ = base_; }
  /// Adds a symmetric block: row 3 k + c is coordinate c of points[k].
  void add(std::span<const int> points, const Eigen::MatrixXd& block);
  /// True if the pattern has grown since the last call of this function, or if this is the first.
  [[nodiscard]] bool renewed();

  [[nodiscard]] const SparseMatrix& sum() const { return sum_; }
  [[nodiscard]] SparseMatrix take_sum() && { return std::move(sum_); }

 private:
  void grow(std::span<const int> points);

  SparseMatrix base_, sum_;
  bool renewed_ = true;
};

/// A ⊗ I of a matrix A between points, with zeros between different coordinates of points that it
/// couples.
[[nodiscard]] SparseMatrix with_coordinate_blocks(const SparseMatrix& a);

}  // namespace knead
