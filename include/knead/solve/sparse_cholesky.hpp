#pragma once

#include <memory>
#include <span>
#include <vector>

#include "knead/energy/stiffness.hpp"

namespace knead {

struct Dissection;
struct GridPlaces;

/// A = L Lᵀ of a sparse symmetric positive definite matrix, with a fill-reducing ordering; factor
/// once, solve many.
class SparseCholesky {
 public:
  /// Uses the lower triangle of A. Error (numerical): A is not positive definite or not finite.
  [[nodiscard]] static Expected<SparseCholesky> factor(const SparseMatrix& a);
  /// The same where A is needed no longer: it is emptied before L is made, which takes several
  /// times its memory.
  [[nodiscard]] static Expected<SparseCholesky> factor(SparseMatrix&& a);

  /// The same by nested dissection, where it is known on which grids the unknowns lie: of
  /// large grids L has fewer entries, and threads share its making and its use, with the same bits
  /// for any number. Error (usage): the places are not those of A's unknowns.
  [[nodiscard]] static Expected<SparseCholesky> factor(SparseMatrix&& a, const GridPlaces& places);

  /// The factor of a matrix that is in the order of its factor; its lower triangle is used. The
  /// nodes must be what `dissect` gives for a matrix with these entries, or none.
  [[nodiscard]] static Expected<SparseCholesky> factor_in_order(const SparseMatrix& lower,
                                                                Dissection dissection);

  /// X with A X = B, three columns at once. Cost: O(nonzeros of L). const and thread-safe.
  [[nodiscard]] Points solve(const Points& b) const;
  /// The same for one column.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

  /// The subset of the factor that a solve uses when right sides are zero except at some unknowns.
  struct Subset {
    std::vector<int> rows;    ///< those unknowns, as rows of the factor
    std::vector<int> panels;  ///< of the factor
  };
  /// Cost: O(rows of those panels).
  [[nodiscard]] Subset subset(std::span<const int> unknowns) const;
  /// A X = B for B given at the unknowns of the subset, in their order, and X needed only there.
  /// Cost: O(nonzeros of the subset), on a tensor net a fraction of the whole that shrinks with its
  /// size. Same bits as `solve`.
  [[nodiscard]] Points solve_within(const Subset& subset, const Points& b) const;
  [[nodiscard]] Eigen::VectorXd solve_within(const Subset& subset, const Eigen::VectorXd& b) const;

  /// z of L z = B, the first half of a solve, in the order of the factor.
  struct Half {
    Eigen::VectorXd values;   ///< four per row for three columns, the last zero
    double squared_norm = 0;  ///< Σ z², that is Bᵀ A⁻¹ B
  };
  [[nodiscard]] Half forward(const Points& b) const;
  [[nodiscard]] Half forward(const Eigen::VectorXd& b) const;
  /// The second half where X is needed only at the unknowns of the subset: half the cost of
  /// `solve_within`.
  void backward_within(const Subset& subset, const Half& z, Points& x) const;
  void backward_within(const Subset& subset, const Half& z, Eigen::VectorXd& x) const;
  /// All of X with A X = share · L z + E B, where E B is B at the unknowns of the subset: half the
  /// work of `solve`, and half of `solve_within`.
  void backward(const Half& z, double share, const Subset& subset, const Points& b,
                Points& x) const;
  void backward(const Half& z, double share, const Subset& subset, const Eigen::VectorXd& b,
                Eigen::VectorXd& x) const;

  [[nodiscard]] int size() const { return size_; }

 private:
  struct Factor;
  SparseCholesky(std::shared_ptr<const Factor> factor, int size)
      : factor_(std::move(factor)), size_(size) {}
  std::shared_ptr<const Factor> factor_;
  int size_;
};

}  // namespace knead
