#pragma once

#include <span>

#include "energy/shell_structure.hpp"
#include "joined_shapes.hpp"
#include "knead/energy/loads.hpp"
#include "knead/solve/linear_constraint.hpp"
#include "model.hpp"

namespace knead {

/// What stays the same while shells move (docs/shell.md), in units of the file. Rows are control
/// points, surface after surface.
struct ShellSetup {
  ModelInput input;  ///< with all rest shapes
  JoinedShapes<2> joined;
  ShellStructure structure;
};

/// The selected surfaces as shells, in their present state.
struct ShellProblem : ShellSetup {
  Points rest, present;
  std::vector<LinearConstraint>
      constraints;  ///< on the displacements from the rest shapes, held points among them
  Points load;      ///< forces on the control points that keep their direction
  std::vector<EdgeMoment> moments;  ///< which follow their edges
};

/// Errors (input): surfaces that are no shells among shells, a rest mode or a load that shells do
/// not have; numbers of the material; those of `join_shapes` and `ShellEnergy::create`.
[[nodiscard]] Expected<ShellProblem> shell_problem(const Scene& scene);

/// Whether a selected surface is a shell.
[[nodiscard]] bool has_shells(const Scene& scene);

/// The model of the selected surfaces as shells. Errors: those of `shell_problem` but for loads.
[[nodiscard]] Expected<std::unique_ptr<Model>> shell_model(const Scene& scene,
                                                           const EvolutionPolicy& evolution);

/// `solved` with the bits of `present` in coordinates that a condition on the displacement from
/// `rest` holds at the present place, to rounding.
[[nodiscard]] Points with_held_bits(Points solved, const Points& present, const Points& rest,
                                    std::span<const LinearConstraint> conditions);

}  // namespace knead
