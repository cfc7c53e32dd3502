#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "constraint_space.hpp"
#include "knead/solve/sparse_cholesky.hpp"

namespace knead {

/// A system A X = B on the unknowns left by linear constraints that is not factored: conjugate
/// gradients, preconditioned with one cycle of multigrid over nested spaces (docs/multigrid.md).
/// Immutable, const is thread-safe; the same bits with any number of threads.
///
/// The unknowns y of X = T y are those of the finest space. Every coarser one is a subspace of the
/// one before, given by a prolongation; its matrix is Pᵀ A P (Galerkin), so that a cycle is
/// symmetric and positive, and no error grows. The smoother is Jacobi's method, damped by the
/// largest eigenvalue of D⁻¹A. The coarsest matrix is factored. All but the finest space is in
/// single precision, which a preconditioner does not notice.
///
/// Against a factor: O(N) memory and time a cycle, where L of a surface takes O(N log N) entries
/// and O(N^1.5) operations. What is lost is locality: every iteration runs over the whole net,
/// while a contact needs a part of L alone (`Minimisation`).
class ConstrainedMultigrid {
 public:
  /// A X for N × 3 numbers.
  using Product = std::function<Points(const Points&)>;

  /// \param a the matrix of `product`, needed no longer: it is emptied.
  /// \param prolongations from the finest space on, N rows in the first one and as many as columns
  /// before in others. Errors: constraints couple coordinates, or there is no prolongation (usage);
  /// the coarsest matrix is not positive definite, or a known displacement is not reproduced to
  /// 1e-3 in 100 iterations (numerical). Cost: two sparse products per space, and the factor of the
  /// coarsest.
  [[nodiscard]] static Expected<ConstrainedMultigrid> create(
      SparseMatrix&& a, Product product, ConstraintSpace space,
      const std::vector<SparseMatrix>& prolongations);

  /// T B Tᵀ r for a force r that is `ConstraintSpace::lumped`; B ≈ (Tᵀ A T)⁻¹ is symmetric and
  /// positive, one cycle.
  [[nodiscard]] Points precondition(const Points& r) const;
  [[nodiscard]] Points product(const Points& x) const { return product_(x); }

  /// The X = T y that solves Tᵀ A X = Tᵀ B to 1e-12 of √(BᵀA⁻¹B) in the energy norm, or to
  /// rounding.
  [[nodiscard]] Points solve(const Points& b) const;

  /// Iterations that reproduced a known displacement to 1e-8 when this was made: how good a cycle
  /// is.
  [[nodiscard]] int iterations() const { return iterations_; }
  [[nodiscard]] const ConstraintSpace& space() const { return space_; }

 private:
  /// Three numbers and a fourth that is not used, in single precision.
  typedef float Four __attribute__((vector_size(16)));
  using Fours = std::vector<Four>;

  /// A matrix by columns in single precision, of which transposed products are needed.
  struct Columns {
    std::vector<int> start = {0}, row;
    std::vector<float> value;

    Columns() = default;
    explicit Columns(const SparseMatrix& a);
    [[nodiscard]] std::size_t count() const { return start.size() - 1; }
    void transposed_times(const Fours& x, Fours& y) const;
  };
  /// From a space to the next coarser one, and back.
  struct Transfer {
    Columns prolongation, restriction;  ///< by its columns, and by its rows
  };
  struct Level {
    Columns a;
    std::vector<float> weight;  ///< of the smoother, times 1 / diagonal
    Transfer next;
  };
  struct Solved {
    Points x;
    int iterations = 0;
  };

  explicit ConstrainedMultigrid(ConstraintSpace space) : space_(std::move(space)) {}
  [[nodiscard]] Points apply(const Points& x) const;
  void cycle(std::size_t level, const Fours& r, Fours& x) const;
  [[nodiscard]] Points coarse(const Points& r) const;
  [[nodiscard]] Solved iterate(const Points& b, double tolerance, int limit) const;
  void add_space(SparseMatrix& matrix, const SparseMatrix& prolongation);

  ConstraintSpace space_;
  Product product_;
  Eigen::VectorXd weight_;  // of the smoother on the finest level; zero where there is no unknown
  Transfer next_;           // from the finest level
  std::vector<Level> levels_;  // the others, but for the coarsest
  std::optional<SparseCholesky> coarsest_;
  int iterations_ = 0;
};

}  // namespace knead
