#pragma once

#include <span>

#include "joined_surfaces.hpp"
#include "knead/energy/edge_moment.hpp"
#include "knead/energy/shell_structure.hpp"
#include "knead/scene/model.hpp"
#include "knead/sculpt/active_shell.hpp"
#include "knead/solve/linear_constraint.hpp"

namespace knead {

/// Everything that shells of the selected surfaces depend on but what loads them.
struct ShellInput {
  ModelInput model;
  std::vector<Elasticity<2>> elasticities;

  friend bool operator==(const ShellInput&, const ShellInput&) = default;
};

/// The selected surfaces as shells (docs/shell.md), in units of the file. Rows are control points, surface after
/// surface.
struct ShellProblem {
  ShellInput input;
  JoinedSurfaces joined;
  std::vector<int> surfaces;  ///< the selection
  ShellStructure structure;
  Points rest, present;
  std::vector<LinearConstraint> constraints;  ///< on the displacements from the rest shapes, held points among them
  Points load;                                ///< forces on the control points that keep their direction
  std::vector<EdgeMoment> moments;            ///< which follow their edges
};

/// \param kept one made before: what it has of the same input is taken from it.
/// Errors (input): surfaces that are no shells among shells, a rest mode or a load that shells do not have; numbers of
/// the material; those of `join_surfaces` and `ShellEnergy::create`.
[[nodiscard]] Expected<ShellProblem> shell_problem(const Scene& scene, const ShellProblem* kept = nullptr);

/// Whether something acts whose forces are not known before the shape is: tools, springs and volcanoes, pressure, wind,
/// a limit.
[[nodiscard]] bool touches_shell(const Scene& scene);

/// The selected surfaces as shells that tools press.
struct ShellModel {
  ShellProblem problem;
  EvolutionPolicy evolution;
  ActiveShell model;

  /// Whether it is a model of this problem that evolves so.
  [[nodiscard]] bool serves(const ShellProblem& other, const EvolutionPolicy& policy) const {
    return evolution == policy && problem.input == other.input;
  }
};
[[nodiscard]] Expected<ShellModel> make_shell_model(const Scene& scene, const ShellProblem& problem,
                                                    const EvolutionPolicy& evolution);

/// What acts on it but tools: `share` of the load, all of the rest. Errors: those of `active_loads`.
[[nodiscard]] Expected<ActiveShellLoads> shell_loads(const Scene& scene, const ShellProblem& problem, double share);

/// `solved` with the bits of `present` in coordinates that a condition on the displacement from `rest` holds at the
/// present place, to rounding.
[[nodiscard]] Points with_held_bits(Points solved, const Points& present, const Points& rest,
                                    std::span<const LinearConstraint> conditions);

}  // namespace knead
