#pragma once

#include <span>
#include <string>

#include "knead/contact/active_spline.hpp"
#include "net_operator.hpp"
#include "solve/step_inverse.hpp"

namespace knead {

/// A⁻¹ of a step, and how it was chosen.
struct ChosenInverse {
  StepInverse inverse;
  StepEngine engine;
};

/// The most control points of a model of D directions for which a matrix is factored without being
/// asked: where the cost of both is about the same. A factor of a volume is much denser.
template <int D>
inline constexpr int direct_points = D == 3 ? 20000 : 90000;

/// The most iterations for eight digits with which cycles are cheaper than a factor. On surfaces of
/// degree 3 and less: 12, the usual number, times points / `direct_points`, since a factor costs
/// n^1.5, and iterations n for each; at least 12 and at most 40. On volumes, and of higher degree,
/// 40: their factors are much denser.
/// \param degree the highest
template <int D>
[[nodiscard]] int most_iterations(int points, int degree);

/// The inverse of the operator A of a step on what constraints leave free, by the solver that the
/// settings ask for. Errors: see `ActiveSpline::create`; `StepSolver::iterative` where there are no
/// nested nets (input).
template <int D>
[[nodiscard]] Expected<ChosenInverse> invert(const NetOperator<D>& a, ConstraintSpace space,
                                             std::span<const Spline<D>> patches,
                                             std::span<const DomainScaling<D>> scalings,
                                             const ActiveSettings<D>& settings);

}  // namespace knead
