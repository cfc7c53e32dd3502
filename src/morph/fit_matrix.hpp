#pragma once

#include <array>
#include <optional>
#include <vector>

#include "knead/hold/constraints.hpp"
#include "knead/solve/sparse_cholesky.hpp"
#include "solve/constraint_space.hpp"

namespace knead::morph {

/// Blocks (c, d) of the three coordinates of a symmetric matrix, as they are stored.
inline constexpr std::array<std::array<int, 2>, 6> coordinate_blocks = {
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

/// M and K of a fit, and the displacements X = T y that keep what is kept, with independent y
/// (`ConstraintSpace`). Immutable.
class FitMatrix {
 public:
  FitMatrix() = default;
  /// \param across what M has too much, by blocks of coordinates: then these are coupled; or empty.
  /// \param kept   conditions on the unknowns, with zero right sides
  /// Errors: those of `ConstraintSpace::create`.
  [[nodiscard]] static Expected<FitMatrix> create(SparseMatrix m, SparseMatrix k,
                                                  std::vector<SparseMatrix> across,
                                                  const ConstraintList& kept);

  /// M X.
  [[nodiscard]] Points times_m(const Points& x) const;
  /// The factor of Tᵀ(M + λK)T. Errors: it cannot be factored.
  [[nodiscard]] Expected<SparseCholesky> factor(double lambda) const;
  /// T (Tᵀ(M + λK)T)⁻¹ Tᵀ B by this factor.
  [[nodiscard]] Points solved(const SparseCholesky& factor, const Points& b) const;

 private:
  void find_order();
  [[nodiscard]] SparseMatrix free_part(SparseMatrix a) const;

  SparseMatrix m_, k_;
  std::vector<SparseMatrix> across_;
  std::optional<ConstraintSpace> space_;  ///< none: nothing is kept
  SparseMatrix t_;                        ///< T, where coordinates are coupled by `across_`
  Eigen::VectorXi order_;                 ///< of elimination
};

}  // namespace knead::morph
