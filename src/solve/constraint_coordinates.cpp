#include "constraint_space.hpp"
#include "knead/solve/eigenmodes.hpp"

namespace knead {
namespace {

using CoordinateRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// M ⊗ I.
CoordinateRows on_three_coordinates(const CoordinateRows& matrix) {
  return knead::on_coordinates(SparseMatrix(matrix));
}

std::vector<int> coordinates_of(const std::vector<int>& points) {
  std::vector<int> result;
  result.reserve(3 * points.size());
  for (const int i : points) {
    for (int c = 0; c < 3; ++c) result.push_back(3 * i + c);
  }
  return result;
}

}  // namespace

// Every block is M ⊗ I: coordinates of one point follow one another, 3 i + c. Right sides move from
// three columns to one.
ConstraintSpace ConstraintSpace::on_coordinates() const {
  ConstraintSpace result = *this;
  if (coupled_) return result;
  result.coupled_ = true;
  result.free_ = coordinates_of(free_);
  result.dependent_ = coordinates_of(dependent_);
  result.position_.assign(3 * position_.size(), -1);
  for (std::size_t k = 0; k < result.free_.size(); ++k)
    result.position_[at(result.free_[k])] = static_cast<int>(k);
  result.rows_ = on_three_coordinates(rows_);
  result.held_rows_ = on_three_coordinates(held_rows_);
  result.values_.setZero(3 * values_.rows(), 3);
  for (Eigen::Index k = 0; k < values_.rows(); ++k) {
    for (Eigen::Index c = 0; c < 3; ++c) result.values_(3 * k + c, 0) = values_(k, c);
  }
  return result;
}

}  // namespace knead
