#pragma once

#include <algorithm>

namespace knead {

// Tolerances and limits of Newton's iteration that do not depend on how A⁻¹ is applied.
//
// The Newton decrement sqrt(gᵀ A⁻¹ g) is an error in the energy norm of the step. It is compared
// with the terms that the step balances, |F|, |K X₀| and the first imbalance, in the same norm.
inline constexpr double relative_tolerance = 1e-11;
// For a tool followed along a path in many small steps.
inline constexpr double followed_tolerance = 1e-8;
// Where the rounding of recomputed forces does not allow more.
inline constexpr double rounded_tolerance = 1e-9;
inline constexpr double sufficient_decrease = 1e-4;
// Of Φ's parts: a gain below it cannot be told from their rounding, some tens of units in the last
// place.
inline constexpr double rounding_of_potential = 1e-14;
inline constexpr int max_newton_iterations = 60;
inline constexpr int max_cg_iterations = 400;
inline constexpr int max_rounded_steps = 4;

/// To what share of its first residual a direction of Newton's iteration is solved for (Eisenstat
/// and Walker, 1996): loose while the iterate is far away, since which points touch will change,
/// and tighter near the end, where a step must not undo the gain of the previous one; never tighter
/// than what is enough of the whole, as the remainder is then only rounding, and directions made
/// from it violate the constraints.
/// \param decrement of the iterate.
/// \param enough A decrement that ends the iteration.
/// \param largest Of the terms that the step balances.
/// \param interactive Whether an error of the displacement is allowed: what the last iteration
/// gains too little of, the next one need not make up for.
inline double direction_tolerance(double decrement, double enough, double largest,
                                  bool interactive) {
  const double loosest = interactive ? 0.1 : 1e-2, factor = interactive ? 1 : 0.1;
  const double last = std::clamp(0.1 * enough / decrement, 1e-8, 1e-2);
  return std::clamp(factor * decrement / largest, last, loosest);
}

}  // namespace knead
