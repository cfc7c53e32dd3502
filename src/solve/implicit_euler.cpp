#include "knead/solve/implicit_euler.hpp"

#include <fmt/format.h>

#include <cmath>

namespace knead {

namespace {

/// Solves for a known smooth displacement, the same at every control point: what an ill-conditioned matrix reproduces
/// worst, since K hardly resists it. A singular matrix that rounding let pass the factorisation is found here too.
Expected<void> check_digits(const SparseMatrix& system, const Partition& partition, const SparseCholesky& cholesky) {
  constexpr double tolerance = 1e-3;
  const Points known = partition.scatter(Points::Ones(partition.free_count(), 3));
  const Points found = cholesky.solve(partition.gather(system * known));
  const double error = (found.array() - 1).abs().maxCoeff();
  if (error <= tolerance) return {};
  return numerical_error(
      fmt::format("the system matrix is too close to singular (a known solution is missed by {:.1e})", error),
      "implicit step", "hold more control points, use a larger lambda, or remove knot spans far shorter than the rest");
}

}  // namespace

Expected<ImplicitEuler> ImplicitEuler::create(SparseMatrix k, const SparseMatrix& w, double lambda,
                                              Partition partition) {
  if (!std::isfinite(lambda) || lambda < 0) {
    return input_error(fmt::format("{} is not a step parameter", lambda), "lambda", "use a finite number >= 0");
  }
  SparseMatrix system = k + lambda * w;
  std::optional<SparseCholesky> cholesky;
  if (partition.free_count() > 0) {
    auto factored = SparseCholesky::factor(partition.restrict(system));
    if (!factored) return std::unexpected(factored.error());
    cholesky = std::move(*factored);
    if (auto checked = check_digits(system, partition, *cholesky); !checked) return std::unexpected(checked.error());
  }
  return ImplicitEuler(std::move(k), std::move(system), std::move(partition), std::move(cholesky));
}

Points ImplicitEuler::solve(const Points& b) const {
  if (!cholesky_) return Points::Zero(b.rows(), 3);
  return partition_.scatter(cholesky_->solve(partition_.gather(b)));
}

Points ImplicitEuler::step(const Points& previous, const Points& force) const {
  const Points residual = force - k_ * previous;
  return previous + solve(residual);
}

}  // namespace knead
