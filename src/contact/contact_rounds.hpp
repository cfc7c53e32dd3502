#pragma once

#include <functional>
#include <string>
#include <vector>

#include "contact_newton.hpp"
#include "patch_potential.hpp"

namespace knead {

// What all steps have in common.
// A step longer than this many sizes of the model is refused.
inline constexpr double run_away = 1e4;
// Of friction: where it is fully developed, in lengths of the model.
inline constexpr double developed_slip = 1e-4;
// Of what holds points within reach, in those of the stiffest tool.
inline constexpr double reach_stiffness = 30;
inline constexpr double missed_constraint = 1e-9;  // of the size of the model

/// Minimisations in rounds: until no rigid tool is penetrated, at and between Gauss points, and a
/// limit is kept.
///
/// An exterior penalty method: what is forbidden is allowed at a cost that rises until the
/// violation is below `rigid_gap` or the limit's tolerance. Lagrange multipliers would allow
/// softer springs, but are a state of each point, to be carried from step to step and over changes
/// of the grid.
template <int D>
class ContactRounds {
 public:
  /// Minimises with the present potential, from where the last minimisation ended; the potential
  /// there.
  using Descend = std::function<PotentialState()>;
  /// The control points there, in the units of the potential.
  using Place = std::function<Points()>;

  ContactRounds(PatchPotential<D>& potential, std::span<const Spline<D>> patches,
                std::span<const int> rows, ContactSummary& summary, std::string& note)
      : potential_(potential), patches_(patches), rows_(rows), summary_(summary), note_(note) {}

  /// Rigid tools begin at this stiffness at least.
  void begin();
  /// Without a limit (0), the minimum without penetration of rigid tools; else no point is further
  /// than the limit from those control points either.
  [[nodiscard]] PotentialState run(double limit, const Points& limit_origin, const Descend& descend,
                                   const Place& place);

 private:
  /// How far rigid tools are penetrated, anywhere, in their sizes.
  struct Entries {
    std::vector<double> of_tool;  // 0 for tools that are not rigid
    double deepest = 0;
    int deepest_tool = -1;
  };

  [[nodiscard]] bool is_rigid(std::size_t t) const {
    return potential_.tool(t).rigid && potential_.tool(t).collides();
  }
  [[nodiscard]] Entries entries(const Points& x) const;
  [[nodiscard]] bool keep_out(const Entries& found, const PotentialState& at_gauss_points);
  void tell_entered(const Entries& found);
  [[nodiscard]] PotentialState touch_rigid(const Descend& descend, const Place& place);

  PatchPotential<D>& potential_;
  std::span<const Spline<D>> patches_;
  std::span<const int> rows_;
  ContactSummary& summary_;
  std::string& note_;
};

}  // namespace knead
