#pragma once

#include <algorithm>
#include <cmath>

#include "greville_force.hpp"
#include "knead/contact/active_spline.hpp"
#include "net_operator.hpp"
#include "solve/step_inverse.hpp"
#include "standing_springs.hpp"
#include "tool/potential.hpp"
#include "tool/tool_load.hpp"

namespace knead {

/// A dynamic step is two stages of this share of it (Alexander's method).
inline const double dynamic_stage = 1 - std::sqrt(0.5);

/// The data of a step; all operators on all unknowns, in normalised units.
///
/// Made once per setting, shared by all steps and by copies; only `sprung`, a cache with a lock of
/// its own, changes.
template <int D>
struct ActiveSpline<D>::Model {
  ActiveSettings<D> settings;
  std::vector<Spline<D>> patches;
  std::vector<int> rows;
  std::vector<DomainScaling<D>> scalings;
  std::vector<ToolGrids<D>> loads;
  std::vector<GrevilleForce<D>> greville;  // for the analytic route
  double length;
  Point centre;  // positions are relative to this point, to keep digits where coordinates are large
  double extent;  // diagonal of the control points, in units of `length`
  Points rest;
  NetOperator<D> stretch, bend, stiffness, weight, mass, damping, a;
  std::optional<double> energy_error;  // of rational patches
  StepInverse inverse;
  StepEngine engine;
  std::shared_ptr<SprungSystems<D>> sprung = std::make_shared<SprungSystems<D>>();

  /// The origin of X.
  [[nodiscard]] Points origin(const ActiveState& state) const {
    if (settings.rest == RestMode::none) return centre.transpose().replicate(rest.rows(), 1);
    return state.rest.rows() > 0 ? state.rest : rest;
  }
  /// Xᵀ K X. K annihilates constants: without their mean the numbers are smaller, and so is the
  /// rounding.
  [[nodiscard]] double energy(const NetOperator<D>& part, const Points& x) const {
    const Points y = x.rowwise() - x.colwise().mean();
    return std::max(0.0, dot(y, part * y));
  }

  /// The system with these forces' `standing_springs` in it; null: there are none, or it cannot be
  /// inverted.
  [[nodiscard]] std::shared_ptr<const SprungSystem<D>> with_springs(
      std::span<const PointForce> forces) const;
  Expected<Points> load_of(const ActiveState& state, const ActiveLoads& given) const;
  void report(ActiveStep& result, const Points& x, const Points& external,
              const PotentialState& contact, std::span<const Tool> tools) const;
};

}  // namespace knead
