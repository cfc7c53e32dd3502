#pragma once

#include <optional>

#include "knead/solve/partition.hpp"
#include "knead/solve/sparse_cholesky.hpp"

namespace knead {

/// The implicit Euler step of the active model (thesis Eq. 4.22 with the sign of F set right):
///
///   (K + λ W) X_t = λ W X_{t−1} + F,
///
/// solved for the increment, X_t = X_{t−1} + (K + λW)^{-1} (F − K X_{t−1}), on the free unknowns. λ is the inverse of a
/// step size. W is the mass matrix (the evolution then does not depend on the net) or the identity (the thesis).
/// Fixed rows keep their bits. Without force the energy Σ Xᵀ K X never grows.
class ImplicitEuler {
 public:
  /// Factors K + λW on the free unknowns and checks that solving for a known displacement gives it back to 1e-3.
  /// Errors: λ negative or not finite (input); the matrix is not positive definite, or too close to singular for the
  /// check (numerical).
  [[nodiscard]] static Expected<ImplicitEuler> create(SparseMatrix k, const SparseMatrix& w, double lambda,
                                                      Partition partition);

  /// One step. `force` and `previous` are N × 3; rows of `force` at fixed unknowns are ignored.
  [[nodiscard]] Points step(const Points& previous, const Points& force) const;

  /// (K + λW)^{-1} B on the free unknowns, zero on the fixed ones.
  [[nodiscard]] Points solve(const Points& b) const;

  [[nodiscard]] const SparseMatrix& k() const { return k_; }
  /// K + λW on all unknowns.
  [[nodiscard]] const SparseMatrix& system() const { return system_; }
  [[nodiscard]] const Partition& partition() const { return partition_; }

 private:
  ImplicitEuler(SparseMatrix k, SparseMatrix system, Partition partition, std::optional<SparseCholesky> cholesky)
      : k_(std::move(k)),
        system_(std::move(system)),
        partition_(std::move(partition)),
        cholesky_(std::move(cholesky)) {}

  SparseMatrix k_, system_;
  Partition partition_;
  std::optional<SparseCholesky> cholesky_;  // none where nothing is free
};

}  // namespace knead
