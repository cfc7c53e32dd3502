#pragma once

#include <memory>
#include <span>
#include <vector>

#include "energy/shell_structure.hpp"
#include "knead/contact/active_spline.hpp"

namespace knead {

/// How an `ActiveShell` or `ActiveForm` moves, and what holds it.
struct ActiveShellSettings {
  Evolution evolution = Evolution::acm;
  double lambda = 1;        ///< acm: inverse step size, of a membrane of stiffness 1
  double time_step = 0.02;  ///< dynamic
  double damping = 0.5;     ///< dynamic: force per momentum, 1/time
  /// dynamic: as in `ActiveSettings`, of shapes without density; 0: that of shells.
  double mass = 0;
  std::vector<bool> held = {};  ///< control points that do not move, one flag each; empty: none
  /// On the displacements from the rest shape, file units.
  std::vector<LinearConstraint> constraints = {};
  std::vector<std::shared_ptr<const VisibleRegion>> visible = {};  ///< as in `ActiveSettings`
  double detail = 0;                                               ///< likewise
  StepAccuracy accuracy = StepAccuracy::exact;
};

/// Shells under tools: the non-linear energy of `ShellStructure` in the place of the linear one of
/// `ActiveSpline`.
///
/// Lengths are divided by L, the normalised length of the first patch, and energies by e = 2 ·
/// `stretching_scale` of the first shell, for a shell E t/(1 − ν²) times its area: a membrane then
/// has the stiffness 1, and tools, friction, limits, λ and tolerances mean what they do in the
/// linear model with α = 1. A step finds
///
///   acm         argmin W(X) − G·X + Ψ(X) + λ/2 |X − X₀|²_B,  B the mass of the scaled domain
///   stationary  argmin W(X) − G·X + Ψ(X), beginning at X₀
///   dynamic     M(V₁ − V₀)/h + D V + ∇W(X_θ) + c − G + ∇Ψ(X₁) = 0,  D = damping · M,
///               X_θ = (1 − θ) X₀ + θ X₁,  Δ = X₁ − X₀ = h V,  V = (1 − θ) V₀ + θ V₁
///
/// first by convex parabolas in the place of W with contact as it is, to an imbalance of 1e-3 of
/// the forces that meet (interactive accuracy), then by Newton's method with the exact Hessian and
/// a line search, to 1e-9 (docs/shell.md). Where the Hessian is indefinite its geometric part is
/// left out, which makes it positive. A dynamic step takes θ = 0.55 and c = 0, nearly the midpoint
/// rule, and keeps the result if g = W₁ − W₀ − ∇W(X_θ)·Δ − (θ − ½) |V₁ − V₀|²_M <= 0; else, where
/// steps are too large to resolve the motion, θ = 1 (implicit Euler) with c = max(0, g) MΔ/(ΔᵀMΔ),
/// found in up to 12 rounds. Either way energy does not grow without loads, however large the step:
/// W₁ + T₁ <= W₀ + T₀ − h VᵀDV (a one-sided discrete gradient, after O. Gonzalez, *Time integration
/// and discrete Hamiltonian systems*, 1996). Forces of pressure, wind and moments are those at the
/// start of the step; a stationary step repeats until they have settled. Immutable, const is
/// thread-safe.
class ActiveShell {
 public:
  /// \param patches rest shapes of the structure's shells, in their order.
  /// Errors: settings out of range, contradictory constraints, other numbers of control points
  /// (input); a shape without area (numerical).
  [[nodiscard]] static Expected<ActiveShell> create(std::vector<Surface> patches,
                                                    ShellStructure structure,
                                                    ActiveShellSettings settings);

  /// One step under tools, in file units; `state.rest` is not read, `state.guess` is where the
  /// search begins. `stretch` and `bend` of the result are membrane and bending energy in units of
  /// the file, as is `kinetic`. Errors (numerical): the result is not finite; a structure that
  /// nothing holds where that is needed.
  [[nodiscard]] Expected<ActiveStep> step(const ActiveState& state, std::span<const Tool> tools,
                                          const ActiveLoads& loads) const;

  [[nodiscard]] const ShellStructure& structure() const;
  /// L, by which lengths are divided.
  [[nodiscard]] double length() const;

 private:
  struct Model;
  struct Run;
  explicit ActiveShell(std::shared_ptr<const Model> model) : model_(std::move(model)) {}
  std::shared_ptr<const Model> model_;
};

}  // namespace knead
