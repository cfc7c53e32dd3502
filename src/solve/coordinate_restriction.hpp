#pragma once

#include <vector>

#include "constraint_space.hpp"
#include "dissection.hpp"

namespace knead {

/// Tᵀ A T of symmetric matrices A over all 3N coordinates that have one pattern, T that of a
/// `ConstraintSpace`, in an order that fills the factor little. What depends on the pattern alone
/// is found once.
class CoordinateRestriction {
 public:
  /// \param space of coordinates (`coupled`).
  /// \param places of the points, where they lie on grids: null where they do not.
  CoordinateRestriction(const ConstraintSpace& space, const SparseMatrix& pattern,
                        const GridPlaces* places = nullptr);

  /// The lower triangle of Tᵀ A T in that order. Cost: one multiply-add per entry of A where
  /// nothing but coordinates is held; where dependent coordinates have so many terms that the
  /// products of all pairs would fill the memory, one per entry of T and unknown, without more
  /// memory than the result.
  [[nodiscard]] SparseMatrix lower(const SparseMatrix& a) const;
  /// The order, and its nodes where places gave it.
  [[nodiscard]] const Dissection& dissection() const { return dissection_; }

 private:
  struct Piece {
    int from, to;  // values of A and of the result
    double coefficient;
  };

  [[nodiscard]] SparseMatrix product(const SparseMatrix& a) const;

  Dissection dissection_;
  SparseMatrix zero_;  // the pattern of the result
  std::vector<Piece> pieces_;
  SparseMatrix map_;  // T, where pieces would be too many
};

}  // namespace knead
