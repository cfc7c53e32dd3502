#include "constrained_cholesky.hpp"

#include <fmt/format.h>

#include "dissection.hpp"
#include "independent_places.hpp"

namespace knead {
namespace {

/// Solves for a known smooth displacement of ones, which an ill-conditioned matrix reproduces
/// worst, since the energy hardly resists it. This also detects a singular matrix that passed the
/// factorisation by rounding.
///
/// With x of ones the solution's relative error is about the condition of the matrix times 1e-16:
/// 1e-3 is left where that is 1e13. A condition estimate would cost several solves; this is one, on
/// the vector that matters. Forces are made from the reduced matrix itself, so that constraints and
/// the assembly of A cannot disagree with the check.
template <class Values>
Expected<void> check_digits(const SparseCholesky& cholesky, const Values& forces) {
  constexpr double tolerance = 1e-3;
  const double error = (cholesky.solve(forces).array() - 1).abs().maxCoeff();
  if (error <= tolerance) return {};
  return numerical_error(
      fmt::format(
          "the system matrix is too close to singular (a known solution is missed by {:.1e})",
          error),
      "factorisation",
      "hold more control points, use a larger lambda, or remove knot spans far shorter than the "
      "rest");
}

}  // namespace

Expected<ConstrainedCholesky> ConstrainedCholesky::factor(SparseMatrix&& a, ConstraintSpace space,
                                                          const GridPlaces* places) {
  std::optional<SparseCholesky> cholesky;
  std::ptrdiff_t entries = 0;
  if (space.free_count() > 0) {
    SparseMatrix reduced = space.restrict(a);
    SparseMatrix().swap(a);
    entries = reduced.nonZeros();
    const Points forces = reduced * Points::Ones(reduced.rows(), 3);
    const auto unknowns = detail::independent_places(space, places);
    auto factored = unknowns ? SparseCholesky::factor(std::move(reduced), *unknowns)
                             : SparseCholesky::factor(std::move(reduced));
    if (!factored) return std::unexpected(factored.error());
    if (auto checked = check_digits(*factored, forces); !checked)
      return std::unexpected(checked.error());
    cholesky = std::move(*factored);
  }
  return ConstrainedCholesky(std::move(space), std::move(cholesky), entries);
}

Expected<ConstrainedCholesky> ConstrainedCholesky::factor(
    const SparseMatrix& a, ConstraintSpace space, const CoordinateRestriction& restriction) {
  std::optional<SparseCholesky> cholesky;
  std::ptrdiff_t entries = 0;
  if (space.free_count() > 0) {
    const SparseMatrix lower = restriction.lower(a);
    entries = lower.nonZeros();
    const Eigen::VectorXd in_order =
        lower.selfadjointView<Eigen::Lower>() * Eigen::VectorXd::Ones(lower.rows());
    const Eigen::VectorXd forces = in_order(restriction.dissection().order);
    auto factored = SparseCholesky::factor_in_order(lower, restriction.dissection());
    if (!factored) return std::unexpected(factored.error());
    if (auto checked = check_digits(*factored, forces); !checked)
      return std::unexpected(checked.error());
    cholesky = std::move(*factored);
  }
  return ConstrainedCholesky(std::move(space), std::move(cholesky), entries);
}

Expected<ConstrainedCholesky> ConstrainedCholesky::factor(const SparseMatrix& a,
                                                          ConstraintSpace space) {
  return factor(SparseMatrix(a), std::move(space));
}

// Points that depend on others bring the unknowns of their definitions. These are numbered anew, 0
// … `count` − 1 in order of appearance, so that a solve within the subset handles short arrays
// only.
ConstrainedCholesky::Subset ConstrainedCholesky::subset(std::vector<int> points) const {
  Subset subset{std::move(points), {}, 0, {}};
  if (!cholesky_) return subset;
  subset.terms = space_.terms(subset.points);
  std::vector<int> unknowns, place(static_cast<std::size_t>(space_.free_count()), -1);
  for (ConstraintSpace::Term& term : subset.terms) {
    int& at = place[static_cast<std::size_t>(term.unknown)];
    if (at < 0) {
      at = static_cast<int>(unknowns.size());
      unknowns.push_back(term.unknown);
    }
    term.unknown = at;
  }
  subset.count = static_cast<int>(unknowns.size());
  subset.factor = cholesky_->subset(unknowns);
  return subset;
}

namespace {

/// Tᵀ b over the unknowns of a subset.
template <class Values>
Values reduced(const ConstrainedCholesky::Subset& subset, const Values& b) {
  Values y = Values::Zero(subset.count, b.cols());
  for (const ConstraintSpace::Term& t : subset.terms)
    y.row(t.unknown) += t.coefficient * b.row(t.row);
  return y;
}

template <class Values>
Values expanded(const ConstrainedCholesky::Subset& subset, const Values& y, Eigen::Index rows) {
  Values x = Values::Zero(rows, y.cols());
  for (const ConstraintSpace::Term& t : subset.terms)
    x.row(t.row) += t.coefficient * y.row(t.unknown);
  return x;
}

Eigen::VectorXd flat(const Points& b) {
  return Eigen::Map<const Eigen::VectorXd>(b.data(), b.size());
}

}  // namespace

Points ConstrainedCholesky::solve_within(const Subset& subset, const Points& b) const {
  if (!cholesky_) return Points::Zero(b.rows(), 3);
  if (!space_.coupled())
    return expanded(subset, cholesky_->solve_within(subset.factor, reduced(subset, b)), b.rows());
  const Eigen::VectorXd x =
      expanded(subset, cholesky_->solve_within(subset.factor, reduced(subset, flat(b))), b.size());
  return Eigen::Map<const Points>(x.data(), b.rows(), 3);
}

ConstrainedCholesky::Half ConstrainedCholesky::forward(const Points& b) const {
  if (!cholesky_) return {};
  if (!space_.coupled()) return cholesky_->forward(space_.reduce_points(b));
  return cholesky_->forward(Eigen::VectorXd(space_.reduce(b).col(0)));
}

Points ConstrainedCholesky::backward_within(const Subset& subset, const Half& half) const {
  const auto rows = static_cast<Eigen::Index>(subset.points.size());
  if (!cholesky_) return Points::Zero(rows, 3);
  if (!space_.coupled()) {
    Points y;
    cholesky_->backward_within(subset.factor, half, y);
    return expanded(subset, y, rows);
  }
  Eigen::VectorXd y;
  cholesky_->backward_within(subset.factor, half, y);
  const Eigen::VectorXd x = expanded(subset, y, 3 * rows);
  return Eigen::Map<const Points>(x.data(), rows, 3);
}

Points ConstrainedCholesky::backward(const Half& half, double share, const Subset& subset,
                                     const Points& b) const {
  if (!cholesky_) return Points::Zero(space_.size(), 3);
  if (!space_.coupled()) {
    Points y;
    cholesky_->backward(half, share, subset.factor, reduced(subset, b), y);
    return space_.expand_points(y);
  }
  Eigen::VectorXd y;
  cholesky_->backward(half, share, subset.factor, reduced(subset, flat(b)), y);
  return space_.expand(y);
}

Points ConstrainedCholesky::solve(const Points& b) const {
  if (!cholesky_) return Points::Zero(b.rows(), 3);
  if (!space_.coupled()) return space_.expand_points(cholesky_->solve(space_.reduce_points(b)));
  return space_.expand(cholesky_->solve(Eigen::VectorXd(space_.reduce(b).col(0))));
}

}  // namespace knead
