#pragma once

#include "knead/energy/edge_moment.hpp"
#include "knead/energy/shell_energy.hpp"
#include "knead/scene/scene.hpp"
#include "knead/solve/linear_constraint.hpp"

namespace knead {

/// The static problem of the selected surface as a shell (docs/shell.md), in units of the file.
struct ShellProblem {
  ShellEnergy energy;
  std::vector<LinearConstraint> constraints;  ///< on the displacements from the rest shape
  Points load;                                ///< forces on the control points, N × 3
  std::vector<EdgeMoment> moments;            ///< which follow their edges
  std::vector<std::string> notes;
};

/// Errors (input): several selected surfaces, tools, springs and volcanoes, a limit, a rest mode or a load that shells
/// do not have; numbers of the material; those of `constraints_of` and `ShellEnergy::create`.
[[nodiscard]] Expected<ShellProblem> shell_problem(const Scene& scene);

/// `solved` with the bits of `present` in coordinates that a condition holds at the present place, to rounding.
[[nodiscard]] Points with_held_bits(const ShellProblem& problem, const Points& rest, const Points& present,
                                    Points solved);

}  // namespace knead
