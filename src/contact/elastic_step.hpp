#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "active_shell.hpp"
#include "contact_rounds.hpp"
#include "elastic_energy.hpp"
#include "solve/constraint_space.hpp"
#include "solve/coordinate_restriction.hpp"

namespace knead {

/// What stays the same from step to step of shapes with a non-linear energy, one after the other.
template <int D>
struct ElasticModel {
  std::vector<Spline<D>> patches;  // at rest
  std::vector<int> rows;           // first of every patch, and the end
  ActiveShellSettings settings;
  std::vector<DomainScaling<D>> scalings = {};
  std::vector<ToolGrids<D>> loads = {};
  ElasticEnergy::Units units = {};
  double extent = 1;
  Points rest = {};
  std::shared_ptr<const ElasticEnergy> energy = {};
  SparseMatrix mass = {};  // of the step: λ B or M, normalised; empty: none
  ConstraintSpace space{0};
  std::optional<CoordinateRestriction> restriction = {};

  /// All but energy, mass and restriction.
  /// \param stretching twice of it is the unit of energy.
  [[nodiscard]] static Expected<ElasticModel> create(std::vector<Spline<D>> patches,
                                                     ActiveShellSettings settings,
                                                     double stretching);
  /// Takes the energy, in these units, and makes the rest.
  /// \param own_mass in units of the file; empty: none.
  [[nodiscard]] Expected<void> complete(std::shared_ptr<const ElasticEnergy> of,
                                        const SparseMatrix& own_mass);
};

/// Adds forces that depend on where the control points x are and how they move, in units of the
/// file; null: there are none.
using FollowingForces = std::function<void(const Points& x, const Points& velocity, Points& sum)>;

/// One step of such a model (`ActiveShell`) under `nodal`, `points` and `limit` of these loads, and
/// forces that follow. Error (usage): loads that only an `ActiveSpline` has.
template <int D>
[[nodiscard]] Expected<ActiveStep> elastic_step(const ElasticModel<D>& model,
                                                const ActiveState& state,
                                                std::span<const Tool> tools,
                                                const ActiveLoads& loads,
                                                const FollowingForces& following = {});

}  // namespace knead
