#pragma once

#include <span>
#include <string>
#include <vector>

#include "constraint_elimination.hpp"
#include "knead/energy/stiffness.hpp"
#include "knead/solve/linear_constraint.hpp"

namespace knead {

/// All X that satisfy a list of linear constraints: X = T y + d with independent unknowns y.
///
/// Some unknowns may be held: they keep their value, to the last bit, and d depends on it. The
/// constraints are eliminated one by one: each expresses one unknown that is not held as a
/// combination of others, the pivot being among its largest coefficients. Constraints that follow
/// from earlier ones, or involve held unknowns only, are skipped. Without a constraint along a
/// normal the three coordinates share one T (N × m); with one, T maps m numbers to all 3N
/// coordinates (`coupled`). Immutable.
class ConstraintSpace {
 public:
  /// Nothing is constrained.
  explicit ConstraintSpace(int size) : size_(size) {
    number_free(std::vector<Definition>(at(size)), false);
  }
  /// Only held points.
  explicit ConstraintSpace(const std::vector<bool>& held)
      : ConstraintSpace(*create(static_cast<int>(held.size()), {}, held)) {}

  /// \param size number of unknown points N.
  /// \param held one flag per unknown point; empty: none.
  /// \param coordinates T maps to all 3N coordinates even where no constraint couples them.
  /// Errors (input): a constraint that contradicts others, both named; an unknown that does not
  /// exist; a number that is not finite, a normal of zero length. Two constraints count as
  /// dependent if elimination leaves less than 1e-11 of the largest coefficient, and as
  /// contradictory if it then leaves more than 1e-9 of the right sides (or of 1, the model's size).
  [[nodiscard]] static Expected<ConstraintSpace> create(
      int size, std::span<const LinearConstraint> constraints, const std::vector<bool>& held = {},
      bool coordinates = false);

  /// The elimination from which `create` makes the space, for those who add constraints to it one
  /// by one. Errors: likewise.
  [[nodiscard]] static Expected<detail::ConstraintElimination> eliminated(
      int size, std::span<const LinearConstraint> constraints, const std::vector<bool>& held = {},
      bool coordinates = false);

  [[nodiscard]] int size() const { return size_; }
  /// Length of y: independent points, or independent coordinates where `coupled`.
  [[nodiscard]] int free_count() const { return static_cast<int>(free_.size()); }
  [[nodiscard]] bool coupled() const { return coupled_; }
  /// The same X with T over coordinates.
  [[nodiscard]] ConstraintSpace on_coordinates() const;
  /// The independent points, or coordinates where `coupled`: row k of y is that of
  /// independent()[k].
  [[nodiscard]] std::span<const int> independent() const { return free_; }
  /// Whether some unknown depends on others, so that X is more than y with zeros where points are
  /// held.
  [[nodiscard]] bool tied() const { return rows_.nonZeros() > 0; }
  /// True if point i is held, or constrained to one place.
  [[nodiscard]] bool is_determined(int i) const;

  /// Tᵀ b: m × 3, or m × 1 where `coupled`.
  [[nodiscard]] Eigen::MatrixXd reduce(const Points& b) const;
  /// T y.
  [[nodiscard]] Points expand(const Eigen::MatrixXd& y) const;
  /// The same for m × 3, directly; only if not `coupled`.
  [[nodiscard]] Points reduce_points(const Points& b) const;
  [[nodiscard]] Points expand_points(const Points& y) const;
  /// One coefficient of T.
  struct Term {
    int row;      ///< an index into the requested rows; three per row and one per coordinate where
                  ///< `coupled`
    int unknown;  ///< of y
    double coefficient;
  };
  /// The rows of T of some points.
  [[nodiscard]] std::vector<Term> terms(std::span<const int> points) const;
  /// Tᵀ A T, or Tᵀ (A ⊗ I) T where `coupled`.
  [[nodiscard]] SparseMatrix restrict(const SparseMatrix& a) const;

  /// A force that does the same work on every T y as b, Tᵀ(lumped b) = Tᵀ b, and acts only on
  /// independent unknowns: the part borne by the constraints is omitted.
  [[nodiscard]] Points lumped(const Points& b) const;

  /// The X with the same independent unknowns that satisfies the constraints. Rows that already do
  /// keep their bits.
  [[nodiscard]] Points feasible(const Points& x) const;

  /// The largest |Σ c X − value| over the constraints, as given.
  [[nodiscard]] double violation(const Points& x) const { return worst(x).second; }
  /// The same with the index of that constraint; −1 if there is none.
  [[nodiscard]] std::pair<int, double> worst(const Points& x) const;
  [[nodiscard]] const std::vector<LinearConstraint>& constraints() const { return constraints_; }

 private:
  using Definition = detail::ConstraintElimination::Definition;

  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  void number_free(const std::vector<Definition>& definitions, bool coupled);

  int size_ = 0;
  bool coupled_ = false;
  std::vector<int> free_,
      position_;  // independent points or coordinates; position_[free_[k]] = k, −1 for others
  std::vector<int> dependent_;                         // unknowns with a row in rows_
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows_;  // dependent_ × m
  Eigen::SparseMatrix<double, Eigen::RowMajor>
      held_rows_;  // dependent_ × all, the held unknowns they depend on
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>
      values_;  // of the dependent ones; column 0 where coupled
  std::vector<LinearConstraint> constraints_;
};

}  // namespace knead
