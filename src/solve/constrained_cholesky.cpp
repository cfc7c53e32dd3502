#include "knead/solve/constrained_cholesky.hpp"

#include <fmt/format.h>

namespace knead {
namespace {

/// Solves for a known smooth displacement: what an ill-conditioned matrix reproduces worst, since an energy hardly
/// resists it. A singular matrix that rounding let pass the factorisation is found here too.
Expected<void> check_digits(const SparseMatrix& reduced, const SparseCholesky& cholesky) {
  constexpr double tolerance = 1e-3;
  const Points known = Points::Ones(reduced.rows(), 3);
  const double error = (cholesky.solve(Points(reduced * known)) - known).cwiseAbs().maxCoeff();
  if (error <= tolerance) return {};
  return numerical_error(
      fmt::format("the system matrix is too close to singular (a known solution is missed by {:.1e})", error),
      "factorisation", "hold more control points, use a larger lambda, or remove knot spans far shorter than the rest");
}

}  // namespace

Expected<ConstrainedCholesky> ConstrainedCholesky::factor(const SparseMatrix& a, ConstraintSpace space) {
  std::optional<SparseCholesky> cholesky;
  if (space.free_count() > 0) {
    const SparseMatrix reduced = space.restrict(a);
    auto factored = SparseCholesky::factor(reduced);
    if (!factored) return std::unexpected(factored.error());
    if (auto checked = check_digits(reduced, *factored); !checked) return std::unexpected(checked.error());
    cholesky = std::move(*factored);
  }
  return ConstrainedCholesky(std::move(space), std::move(cholesky));
}

Points ConstrainedCholesky::solve(const Points& b) const {
  if (!cholesky_) return Points::Zero(b.rows(), 3);
  if (!space_.coupled()) return space_.expand_points(cholesky_->solve(space_.reduce_points(b)));
  return space_.expand(cholesky_->solve(Eigen::VectorXd(space_.reduce(b).col(0))));
}

}  // namespace knead
