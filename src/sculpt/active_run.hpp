#pragma once

#include <string>
#include <vector>

#include "active_model.hpp"
#include "contact_newton.hpp"
#include "patch_potential.hpp"

namespace knead {

/// One step: predict (the forces and the initial problem), touch (the actions of tools, friction and point forces),
/// balance (the minimum, in rounds if rigid, limited or analytic), accept (checks, and the result).
template <int D>
struct ActiveSpline<D>::Run {
  Run(const Model& model, const ActiveState& state, std::span<const Tool> tools, const ActiveLoads& loads,
      Points external);

  void touch();
  void balance();
  [[nodiscard]] Expected<ActiveStep> accept();

 private:
  /// How far rigid tools are penetrated, anywhere, in their sizes.
  struct Entries {
    std::vector<double> of_tool;  // 0 for tools that are not rigid
    double deepest = 0;
    int deepest_tool = -1;
  };

  [[nodiscard]] bool is_rigid(std::size_t t) const { return potential.tool(t).rigid && potential.tool(t).collides(); }
  void balance_dynamic();
  [[nodiscard]] PotentialState descend(const StepProblem& step);
  [[nodiscard]] Entries entries(const Points& x) const;
  [[nodiscard]] bool keep_out(const Entries& found, const PotentialState& contact);
  void tell_entered(const Entries& found);
  [[nodiscard]] PotentialState touch_rigid(const StepProblem& step);
  [[nodiscard]] PotentialState keep_within_limit(const StepProblem& step);
  [[nodiscard]] Points greville_correction(const Points& x) const;
  [[nodiscard]] PotentialState settle(const StepProblem& step);

  const Model& m;
  const ActiveState& state;
  std::span<const Tool> tools;
  const ActiveLoads& loads;
  std::vector<ModelTool> scaled;  // the tools, in the model's units
  Points file_origin, before;     // the origin of X, and X₀
  Points external;                // G
  StepProblem problem;
  PatchPotential<D> potential;
  double limit;         // no point moves further than this from
  Points limit_origin;  // these control points
  Points y;             // X − X₀
  Points velocity;      // after a dynamic step
  Points lagged;        // what the analytic route adds to the Gauss forces
  PotentialState contact;
  ContactSummary summary = {0, 0, true, true};
  std::string note;
};

}  // namespace knead
