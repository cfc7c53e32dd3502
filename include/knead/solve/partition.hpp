#pragma once

#include <vector>

#include "knead/energy/stiffness.hpp"

namespace knead {

/// Unknowns divided into free ones and fixed ones. Fixing eliminates: a fixed unknown is no unknown of the reduced
/// system and keeps its value to the last bit.
class Partition {
 public:
  /// \param fixed one flag per unknown.
  explicit Partition(std::vector<bool> fixed);
  /// All free.
  explicit Partition(int size) : Partition(std::vector<bool>(static_cast<std::size_t>(size), false)) {}

  [[nodiscard]] int size() const { return static_cast<int>(position_.size()); }
  [[nodiscard]] int free_count() const { return static_cast<int>(free_.size()); }
  [[nodiscard]] bool is_free(int i) const { return position_[static_cast<std::size_t>(i)] >= 0; }
  /// Indices of the free unknowns, ascending.
  [[nodiscard]] const std::vector<int>& free() const { return free_; }

  /// Rows of x that are free.
  [[nodiscard]] Points gather(const Points& x) const;
  /// A full vector with the free rows given and zero elsewhere.
  [[nodiscard]] Points scatter(const Points& free_rows) const;
  /// x with its fixed rows set to zero.
  [[nodiscard]] Points free_part(Points x) const;
  /// The block of free rows and columns.
  [[nodiscard]] SparseMatrix restrict(const SparseMatrix& matrix) const;

 private:
  std::vector<int> free_, position_;  // position_[i] = place of i among the free ones, −1 where fixed
};

}  // namespace knead
