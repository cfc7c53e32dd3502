#include "fit_matrix.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/interruption.hpp"
#include "knead/energy/stiffness.hpp"
#include "solve/dissection.hpp"

namespace knead::morph {
namespace {

constexpr std::array<std::array<std::size_t, 3>, 3> block_of = {{{0, 3, 4}, {3, 1, 5}, {4, 5, 2}}};

/// A with its coordinates coupled by what it has too much. Unknowns of one control point follow
/// each other: x, y, z.
SparseMatrix coupled(const SparseMatrix& a, const std::vector<SparseMatrix>& across) {
  SparseMatrix result(3 * a.rows(), 3 * a.cols());
  result.reserve(9 * a.nonZeros());
  for (int k = 0; k < a.outerSize(); ++k) {
    for (int c = 0; c < 3; ++c) {
      result.startVec(3 * k + c);
      const auto& blocks = block_of[static_cast<std::size_t>(c)];
      std::array<SparseMatrix::InnerIterator, 3> less = {
          SparseMatrix::InnerIterator(across[blocks[0]], k),
          SparseMatrix::InnerIterator(across[blocks[1]], k),
          SparseMatrix::InnerIterator(across[blocks[2]], k)};
      for (SparseMatrix::InnerIterator at(a, k); at; ++at) {
        for (int d = 0; d < 3; ++d) {
          auto& block = less[static_cast<std::size_t>(d)];
          double value = c == d ? at.value() : 0;
          if (block && block.row() == at.row()) {
            value -= block.value();
            ++block;
          }
          if (value != 0 || c == d) result.insertBack(3 * at.row() + d, 3 * k + c) = value;
        }
      }
    }
  }
  result.finalize();
  return result;
}

/// T over all coordinates.
SparseMatrix map_of(const ConstraintSpace& space) {
  std::vector<int> all(static_cast<std::size_t>(space.size()));
  std::iota(all.begin(), all.end(), 0);
  std::vector<Eigen::Triplet<double>> entries;
  for (const ConstraintSpace::Term& term : space.terms(all))
    entries.emplace_back(term.row, term.unknown, term.coefficient);
  SparseMatrix result(3 * space.size(), space.free_count());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

bool keeps_something(const ConstraintList& kept) {
  return !kept.constraints.empty() || std::ranges::find(kept.held, true) != kept.held.end();
}

}  // namespace

Expected<FitMatrix> FitMatrix::create(SparseMatrix m, SparseMatrix k,
                                      std::vector<SparseMatrix> across,
                                      const ConstraintList& kept) {
  FitMatrix result;
  result.m_ = std::move(m);
  result.k_ = std::move(k);
  result.across_ = std::move(across);
  if (keeps_something(kept)) {
    const bool coordinates = !result.across_.empty();
    auto space = ConstraintSpace::create(static_cast<int>(kept.held.size()), kept.constraints,
                                         kept.held, coordinates);
    if (!space) return std::unexpected(space.error());
    result.space_ = *std::move(space);
    if (coordinates) result.t_ = map_of(*result.space_);
  }
  result.find_order();
  return result;
}

/// What of a matrix on all unknowns, or on all coordinates where these are coupled, is left to the
/// free ones.
SparseMatrix FitMatrix::free_part(SparseMatrix a) const {
  if (!space_) return a;
  if (across_.empty()) return space_->restrict(a);
  return SparseMatrix(t_.transpose()) * a * t_;
}

// For all λ at once. Coordinates of a control point stay together where data alone couple them: the
// order of the control points is as good for them, and found in a ninth of the entries.
void FitMatrix::find_order() {
  const SparseMatrix both = m_ + k_;
  if (across_.empty() || space_) {
    order_ = minimum_degree(free_part(across_.empty() ? both : coupled(both, across_))).order;
    return;
  }
  const Eigen::VectorXi order = minimum_degree(both).order;
  order_.resize(3 * order.size());
  for (Eigen::Index k = 0; k < order.size(); ++k) {
    for (int c = 0; c < 3; ++c) order_[3 * k + c] = 3 * order[k] + c;
  }
}

Points FitMatrix::times_m(const Points& x) const {
  Points result = symmetric_product(m_, x);
  for (std::size_t c = 0; c < across_.size(); ++c) {
    const auto [i, j] = coordinate_blocks[c];
    result.col(i) -= across_[c] * x.col(j);
    if (i != j) result.col(j) -= across_[c] * x.col(i);
  }
  return result;
}

Points FitMatrix::solved(const SparseCholesky& factor, const Points& b) const {
  if (space_) {
    const Eigen::MatrixXd right = space_->reduce(b);
    if (space_->coupled()) return space_->expand(factor.solve(Eigen::VectorXd(right.col(0))));
    return space_->expand(factor.solve(Points(right)));
  }
  if (across_.empty()) return factor.solve(b);
  Eigen::VectorXd right(3 * b.rows());
  for (Eigen::Index k = 0; k < b.rows(); ++k) right.segment<3>(3 * k) = b.row(k).transpose();
  const Eigen::VectorXd x = factor.solve(right);
  Points result(b.rows(), 3);
  for (Eigen::Index k = 0; k < b.rows(); ++k) result.row(k) = x.segment<3>(3 * k).transpose();
  return result;
}

// The diagonal is raised by a share that rounding takes anyway: with spans of very unequal lengths
// M + λK is positive definite only up to it, and with slopes beside poles up to more. What is added
// is part of the regularisation, whose influence the repeated solves remove, since the right side
// has the exact M.
Expected<SparseCholesky> FitMatrix::factor(double lambda) const {
  constexpr double least_raise = 1e-13, most_raise_of_diagonal = 1e-6;
  for (double raise = least_raise;; raise *= 100) {
    SparseMatrix a = m_ + lambda * k_;
    if (!across_.empty()) a = coupled(a, across_);
    a = free_part(std::move(a));
    for (int k = 0; k < a.cols(); ++k) a.coeffRef(k, k) *= 1 + raise;
    SparseMatrix lower(a.rows(), a.cols());
    lower.selfadjointView<Eigen::Lower>() = a.selfadjointView<Eigen::Lower>().twistedBy(
        Eigen::PermutationMatrix<Eigen::Dynamic>(order_));
    SparseMatrix().swap(a);
    auto result = SparseCholesky::factor_in_order(lower, {order_, {}});
    if (Interruption::asked_for()) return interrupted_error();  // what it made means nothing
    if (result || raise > most_raise_of_diagonal) return result;
  }
}

}  // namespace knead::morph
