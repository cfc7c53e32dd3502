#pragma once

#include "fit_nets.hpp"
#include "knead/energy/stiffness.hpp"

namespace knead::morph {

/// Σ w r rᵀ and Σ w r dᵀ of weighted rows. Rows with the same unknowns that follow each other are
/// summed up in a dense block first, so that many points within a cell of knots take the memory of
/// one. The sums depend on the order of the rows alone.
class NormalEquations {
 public:
  explicit NormalEquations(int unknowns)
      : right_(Points::Zero(unknowns, 3)), lower_(unknowns, unknowns) {}

  void add(const Terms& row, double weight, const Point& value);
  /// An operator of its own on the control points from `first` on, times a factor.
  void add(const SparseMatrix& own, std::span<const int> unknown, double factor);

  [[nodiscard]] const Points& right() const { return right_; }
  /// Both triangles. Ends the sums.
  [[nodiscard]] SparseMatrix matrix();

 private:
  void flush();
  void enter(int row, int column, double value);
  void compress();
  void compress_if_many();

  Points right_;
  std::vector<int> current_;
  Eigen::MatrixXd block_;
  Eigen::VectorXd row_;
  std::vector<Eigen::Triplet<double>> entries_;  ///< of the lower triangle, not yet in `lower_`
  SparseMatrix lower_;
};

}  // namespace knead::morph
