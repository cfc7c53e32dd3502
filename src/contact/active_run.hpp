#pragma once

#include <string>
#include <vector>

#include "active_model.hpp"
#include "contact_newton.hpp"
#include "contact_rounds.hpp"
#include "patch_potential.hpp"

namespace knead {

/// One step: predict (the forces and the initial problem), touch (the actions of tools, friction
/// and point forces), balance (the minimum, in rounds if rigid, limited or analytic), accept
/// (checks, and the result).
template <int D>
struct ActiveSpline<D>::Run {
  Run(const Model& model, const ActiveState& state, std::span<const Tool> tools,
      const ActiveLoads& loads, Points external);

  void touch();
  void balance();
  [[nodiscard]] Expected<ActiveStep> accept();

 private:
  void balance_dynamic();
  [[nodiscard]] PointForce scaled_force(PointForce force) const;
  [[nodiscard]] PotentialState descend(const StepProblem& step);
  [[nodiscard]] PotentialState keep_within_limit(const StepProblem& step);
  [[nodiscard]] Points greville_correction(const Points& x) const;
  [[nodiscard]] PotentialState settle(const StepProblem& step);

  const Model& m;
  const ActiveState& state;
  std::span<const Tool> tools;
  const ActiveLoads& loads;
  std::vector<ModelTool> scaled;                  // the tools, in the model's units
  Points file_origin, before;                     // the origin of X, and X₀
  Points external;                                // G
  std::shared_ptr<const SprungSystem<D>> sprung;  // null: all springs act through the potential
  std::vector<PointForce> springs;                // those in the matrix, in the model's units
  StepProblem problem;
  FactorSource source;
  PatchPotential<D> potential;
  double limit;         // no point moves further than this from
  Points limit_origin;  // these control points
  Points y;             // X − X₀
  Points velocity;      // after a dynamic step
  Points lagged;        // what the analytic route adds to the Gauss forces
  PotentialState contact;
  ContactSummary summary = {0, 0, true, true};
  std::string note;
  ContactRounds<D> rounds;
};

}  // namespace knead
