#pragma once

#include <span>
#include <string>
#include <vector>

#include "energy/shell_structure.hpp"
#include "knead/energy/loads.hpp"
#include "knead/solve/linear_constraint.hpp"

namespace knead {

/// How the equilibrium of a shell is sought.
struct ShellStaticsOptions {
  /// >= 1: the load is applied in this many equal parts; fewer where one does not converge.
  int increments = 1;
  double tolerance = 1e-8;  ///< imbalance of the free unknowns, relative to the load or, without,
                            ///< the first imbalance
  int max_iterations = 30;  ///< of Newton's method per increment
  int max_halvings = 8;     ///< of an increment that does not converge
};

/// One part of the load.
struct ShellIncrement {
  double load_factor;   ///< share of the load at its end
  int iterations;       ///< Newton steps, those of attempts that were halved included
  double residual;      ///< imbalance left, as in `ShellStaticsOptions::tolerance`
  Points displacement;  ///< from the rest shape, N × 3
};

/// A shell in equilibrium.
struct ShellEquilibrium {
  Points control_points;
  Points reactions;  ///< what constraints exert on the control points, N × 3: internal forces less
                     ///< the load
  double load_factor = 0;  ///< of the last increment that converged: 1 if all did
  std::vector<ShellIncrement> increments;
  bool converged = true;
  std::string note;  ///< why not, and what would help
};

/// The control points x at which ∂W/∂x = load on all that the constraints leave free, by Newton's
/// method from the rest shape along an increasing load. The stresses of the Hessian's geometric
/// part are those of the linearised strains (mixed integration points: Magisano, Leonetti and
/// Garcea 2017), which needs fewer iterations; the equilibrium is the same. It need not be stable.
///
/// \param constraints on the displacements of control points, in lengths of the rest shape.
/// \param load forces on the control points, N × 3, that keep their directions.
/// \param moments on edges, which follow them; increased with the load.
/// Errors: constraints that contradict each other, a load of another size, options out of range
/// (input); a structure that is free to move without strain (numerical). An increment that does not
/// converge even when halved is no error: the result is then the last equilibrium, with `converged`
/// false and a note. Cost: per iteration one Hessian and one sparse factorisation.
[[nodiscard]] Expected<ShellEquilibrium> shell_equilibrium(
    const ShellStructure& shell, const Points& rest, std::span<const LinearConstraint> constraints,
    const Points& load, const ShellStaticsOptions& options = {},
    std::span<const EdgeMoment> moments = {});

/// The displacement of the linear theory, the limit of small loads and small values of the
/// constraints: K u = load on all that the constraints leave free, K the Hessian at rest. Errors:
/// those above. Cost: one sparse factorisation.
[[nodiscard]] Expected<Points> linear_displacement(const ShellStructure& shell, const Points& rest,
                                                   std::span<const LinearConstraint> constraints,
                                                   const Points& load);

}  // namespace knead
