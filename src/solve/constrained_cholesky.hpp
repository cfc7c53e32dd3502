#pragma once

#include <cstddef>
#include <optional>

#include "constraint_space.hpp"
#include "coordinate_restriction.hpp"
#include "dissection.hpp"
#include "knead/solve/sparse_cholesky.hpp"

namespace knead {

/// A symmetric system A X = B on the unknowns left by linear constraints: T (Tᵀ A T)⁻¹ Tᵀ, factored
/// once. Immutable, const is thread-safe.
///
/// The null-space method: with X = T y + d the constrained minimum is that of a smaller system,
/// which is positive definite where A is on the admissible y. Multipliers would make it larger and
/// indefinite, penalties ill-conditioned. The price is fill: an unknown that depends on k others
/// couples these k (`CoordinateRestriction` for those that depend on hundreds).
class ConstrainedCholesky {
 public:
  /// Factors Tᵀ A T and checks that solving for a known displacement, the same at every independent
  /// unknown, reproduces it to 1e-3. Errors (numerical): not positive definite, or too close to
  /// singular for the check.
  [[nodiscard]] static Expected<ConstrainedCholesky> factor(const SparseMatrix& a,
                                                            ConstraintSpace space);
  /// The same where A is needed no longer: it is emptied before the factor is made.
  /// \param places of the points, where they lie on grids: null where they do not.
  [[nodiscard]] static Expected<ConstrainedCholesky> factor(SparseMatrix&& a, ConstraintSpace space,
                                                            const GridPlaces* places = nullptr);

  /// The same of A over all 3N coordinates, of the pattern of the restriction, whose space this is:
  /// T Tᵀ A T instead of T Tᵀ (A ⊗ I) T. Errors: likewise.
  [[nodiscard]] static Expected<ConstrainedCholesky> factor(
      const SparseMatrix& a, ConstraintSpace space, const CoordinateRestriction& restriction);

  /// The X = T y that solves Tᵀ A X = Tᵀ B, for B of N × 3. Cost: O(nonzeros of the factor).
  [[nodiscard]] Points solve(const Points& b) const;

  /// The subset used by a solve when right sides are zero except at some points.
  struct Subset {
    std::vector<int> points;
    std::vector<ConstraintSpace::Term> terms;  ///< rows of T of those points, over `count` unknowns
    int count = 0;
    SparseCholesky::Subset factor;
  };
  [[nodiscard]] Subset subset(std::vector<int> points) const;
  /// X at the points of the subset, for B given there and zero elsewhere, both in the order of the
  /// points. Cost and bits: see `SparseCholesky::solve_within`.
  [[nodiscard]] Points solve_within(const Subset& subset, const Points& b) const;
  /// The first half of a solve, with Bᵀ X; the second half where X is needed only at the points of
  /// the subset; the second half everywhere, for share · B + E b with b at the points of the
  /// subset.
  using Half = SparseCholesky::Half;
  [[nodiscard]] Half forward(const Points& b) const;
  [[nodiscard]] Points backward_within(const Subset& subset, const Half& half) const;
  [[nodiscard]] Points backward(const Half& half, double share, const Subset& subset,
                                const Points& b) const;

  [[nodiscard]] const ConstraintSpace& space() const { return space_; }
  /// Of Tᵀ A T, both triangles; where A is given over coordinates, of one.
  [[nodiscard]] std::ptrdiff_t entries() const { return entries_; }

 private:
  ConstrainedCholesky(ConstraintSpace space, std::optional<SparseCholesky> cholesky,
                      std::ptrdiff_t entries)
      : space_(std::move(space)), cholesky_(std::move(cholesky)), entries_(entries) {}

  ConstraintSpace space_;
  std::optional<SparseCholesky> cholesky_;  // none if nothing is free
  std::ptrdiff_t entries_;
};

}  // namespace knead
