#pragma once

#include <span>

#include "knead/spline/knot_vector.hpp"

namespace knead::examples {

/// How the product of a step and an impulse at the same knot is read.
enum class StepTimesImpulse {
  mean,   ///< the impulse times the mean of the step's two limits: right
  after,  ///< times its limit from the right, one of what thesis Eq. 5.38 leaves open
};

/// ∫ α N_i N_j du for a varying coefficient α = Σ c_k B_k, by thesis Eq. 5.38: α is integrated, and
/// the product f of the basis functions differentiated, until only impulses at knots are left,
///
///   ∫ α f du = Σ_ξ Σ_{r=0}^{2p} (−1)^(r+1) [f^(r)]_ξ A_{r+1}(ξ),   A_k the k-fold integral of α
///   from −∞.
///
/// By Leibniz' rule [f^(r)] = Σ_k C(r, k) ([N_i^(k)] N_j^(r−k) + N_i^(k) [N_j^(r−k)]), in which
/// both factors may jump at the same knot. Requires: clamped knots, one domain (asserted). Cost:
/// O(p²) per knot of the support and function of α. Accuracy: the terms cancel; see
/// docs/gramians/coefficients-and-weights.md.
[[nodiscard]] double varying_by_impulses(const KnotVector& knots, int i, int j,
                                         const KnotVector& coefficient_knots,
                                         std::span<const double> coefficients,
                                         StepTimesImpulse reading = StepTimesImpulse::mean);

}  // namespace knead::examples
