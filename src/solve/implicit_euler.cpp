#include "knead/solve/implicit_euler.hpp"

#include <fmt/format.h>

#include <cmath>

namespace knead {

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
