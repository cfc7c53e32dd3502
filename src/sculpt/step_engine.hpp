#pragma once

#include <span>
#include <string>

#include "knead/sculpt/active_spline.hpp"
#include "net_operator.hpp"
#include "solve/step_inverse.hpp"

namespace knead {

/// A⁻¹ of a step, and how it was chosen.
struct ChosenInverse {
  StepInverse inverse;
  StepEngine engine;
};

/// The inverse of the operator A of a step on what constraints leave free, by the solver that the settings ask for.
/// Errors: see `ActiveSpline::create`; `StepSolver::iterative` where there are no nested nets (input).
template <int D>
[[nodiscard]] Expected<ChosenInverse> invert(const NetOperator<D>& a, ConstraintSpace space,
                                             std::span<const Spline<D>> patches,
                                             std::span<const DomainScaling<D>> scalings,
                                             const ActiveSettings<D>& settings);

}  // namespace knead
