#pragma once

#include <vector>

#include "knead/energy/shell_energy.hpp"
#include "shell_crease.hpp"

namespace knead {

/// Shells and the creases between them: one energy of all their control points, N × 3, shell after
/// shell. What joins edges in position, and smooth ones in their tangent planes, are linear
/// constraints. Immutable, const is thread-safe.
class ShellStructure {
 public:
  /// One shell is a structure, too.
  ShellStructure(ShellEnergy shell)
      : ShellStructure(std::vector<ShellEnergy>{std::move(shell)}) {}  // NOLINT
  /// At least one shell. Rows of creases are those of `rows`.
  explicit ShellStructure(std::vector<ShellEnergy> shells, std::vector<ShellCrease> creases = {});

  [[nodiscard]] const std::vector<ShellEnergy>& shells() const { return shells_; }
  [[nodiscard]] const std::vector<ShellCrease>& creases() const { return creases_; }
  /// First control point of every shell, and their number.
  [[nodiscard]] const std::vector<int>& rows() const { return rows_; }
  [[nodiscard]] int size() const { return rows_.back(); }

  /// The sums of `ShellEnergy`'s; what opens creases counts as bending.
  [[nodiscard]] ShellParts energy(const Points& x) const;
  /// The same, and its gradient.
  [[nodiscard]] ShellParts energy(const Points& x, Points& gradient) const;
  [[nodiscard]] Points gradient(const Points& x) const;
  /// One per shell.
  using Stress = std::vector<ShellStress>;
  [[nodiscard]] Stress stress(const Points& x) const;
  [[nodiscard]] Stress stress(const Points& x, const Points& d) const;
  [[nodiscard]] Stress tension(const Stress& stress) const;
  /// Of creases Gauss and Newton's part. The pattern is the same at every x.
  [[nodiscard]] SparseMatrix hessian(const Points& x) const { return hessian(x, stress(x)); }
  [[nodiscard]] SparseMatrix hessian(const Points& x, const Stress& stress) const;
  /// Without the geometric part of the shells: positive semidefinite.
  [[nodiscard]] SparseMatrix material_hessian(const Points& x) const;
  /// N × N.
  [[nodiscard]] SparseMatrix mass() const;
  /// Of the first shell: all energies are judged by it.
  [[nodiscard]] double stretching_scale() const { return shells_.front().stretching_scale(); }

 private:
  [[nodiscard]] auto rows_of(const Points& x, std::size_t k) const {
    return x.middleRows(rows_[k], rows_[k + 1] - rows_[k]);
  }

  std::vector<ShellEnergy> shells_;
  std::vector<ShellCrease> creases_;
  std::vector<int> rows_ = {0};
};

}  // namespace knead
