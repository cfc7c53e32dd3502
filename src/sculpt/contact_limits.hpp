#pragma once

namespace knead {

// Tolerances and limits of Newton's iteration that do not depend on how A⁻¹ is applied.
//
// The Newton decrement sqrt(gᵀ A⁻¹ g) is an error in the energy norm of the step. It is compared with the terms that
// the step balances, |F|, |K X₀| and the first imbalance, in the same norm.
inline constexpr double relative_tolerance = 1e-11;
inline constexpr double followed_tolerance = 1e-8;  // for a tool followed along a path in many small steps
inline constexpr double rounded_tolerance = 1e-9;   // where the rounding of recomputed forces does not allow more
inline constexpr double sufficient_decrease = 1e-4;
inline constexpr double rounding_of_potential = 1e-14;
inline constexpr int max_newton_iterations = 60;
inline constexpr int max_cg_iterations = 400;
inline constexpr int max_rounded_steps = 4;

}  // namespace knead
