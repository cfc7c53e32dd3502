#include "plastic_history.hpp"

#include <cassert>

namespace knead {

void remember(Points& history, const Points& displacement) {
  assert(history.rows() == displacement.rows());
  for (Eigen::Index i = 0; i < history.rows(); ++i) {
    if (displacement.row(i).squaredNorm() > history.row(i).squaredNorm())
      history.row(i) = displacement.row(i);
  }
}

Points staying(const Points& history, const Plasticity& plasticity) {
  if (plasticity.share == 1 && plasticity.yield == 0) return history;
  Points result = history;
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    const double size = history.row(i).norm();
    result.row(i) *= size > plasticity.yield ? plasticity.share * (1 - plasticity.yield / size) : 0;
  }
  return result;
}

// β(Δ − 1/ℓ²)² = βΔ² − (2β/ℓ²)Δ + β/ℓ⁴: the double root is the case between alternation (complex
// roots) and two lengths (real ones).
Locality locality_of(double beta, double length) {
  const double square = length * length;
  return {beta / (square * square), 2 * beta / square};
}

}  // namespace knead
