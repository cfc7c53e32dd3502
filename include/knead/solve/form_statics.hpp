#pragma once

#include <span>
#include <string>

#include "knead/energy/form_energy.hpp"
#include "knead/solve/linear_constraint.hpp"

namespace knead {

/// How the minimum is sought.
struct FormStaticsOptions {
  double tolerance = 1e-9;   ///< imbalance of the free unknowns, relative to the forces, or without to the first one
  int max_iterations = 200;  ///< of Newton's method
};

/// A curve or volume at a minimum.
struct FormEquilibrium {
  Points control_points;
  double residual = 0;  ///< imbalance left, as in `FormStaticsOptions::tolerance`
  int iterations = 0;
  bool converged = true;
  std::string note;  ///< why not, and what would help
};

/// The nearest minimum of W(x) − f·x under linear constraints, by Newton's method with the exact Hessian and a line
/// search. Where the Hessian is not positive definite its part of second derivatives of the forms is left out, and what
/// then costs nothing is damped: motions without energy and force, as a free curve's turns, do not happen.
///
/// \param start where the search begins. \param constraints on the displacements from `rest`.
/// \param load forces on the control points that keep their direction, N × 3.
/// Errors: constraints that contradict each other, a load of another size (input); a shape that the load moves without
/// end, since nothing holds it (numerical). Cost: per iteration one Hessian and one sparse factorisation.
template <int D>
[[nodiscard]] Expected<FormEquilibrium> form_equilibrium(const FormEnergy<D>& energy, const Points& rest,
                                                         const Points& start,
                                                         std::span<const LinearConstraint> constraints,
                                                         const Points& load, const FormStaticsOptions& options = {});

}  // namespace knead
