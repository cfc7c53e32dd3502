#pragma once

#include <memory>
#include <span>
#include <vector>

#include "knead/energy/material.hpp"
#include "knead/gramian/gramian.hpp"
#include "knead/sculpt/domain_scaling.hpp"
#include "knead/sculpt/tool.hpp"

namespace knead {

/// What the energy acts on.
enum class RestMode {
  shape,  ///< the displacement from the rest surface: at rest nothing moves (the default for CAD files)
  none,   ///< the surface itself, as in the thesis: without forces it shrinks to a point
};

/// The weight W of the implicit Euler step.
enum class StepWeight {
  mass,      ///< the mass matrix: refining the net does not change the evolution
  identity,  ///< the identity, the thesis' Eq. 4.22: the evolution depends on the net
};

/// Everything that decides the matrices of an `ActiveSurface`.
struct ActiveSettings {
  Material material;
  RestMode rest = RestMode::shape;
  StepWeight weight = StepWeight::mass;
  double lambda = 1;        ///< inverse step size
  std::vector<bool> fixed;  ///< control points that do not move, one flag each; empty: none
  double detail = 0;        ///< smallest tool dimension the forces must resolve, file units; 0: no tool
  GramianMethod method = default_gramian_method;

  friend bool operator==(const ActiveSettings&, const ActiveSettings&) = default;
};

/// One step of an `ActiveSurface`.
struct ActiveStep {
  Points control_points;  ///< file units; rows that did not move keep their bits
  double energy = 0;      ///< Σ Xᵀ K X after the step (thesis Eq. 4.14), normalised units
  double residual = 0;  ///< imbalance |F − K X| at the free control points, relative to the forces of tools, free part
                        ///< and held part of the net that meet there: 0 in equilibrium
  int iterations = 0;     ///< Newton iterations
  int solves = 0;         ///< back substitutions with the factored matrix
  bool converged = true;  ///< the step's own minimum was reached
};

/// A surface that resists stretch and bend, pressed on by tools: the active model of thesis chapter 4.
///
/// Unknown is X, the displacement of the control points from the rest surface (`RestMode::shape`) or the control points
/// about a fixed origin (`RestMode::none`), in units of a normalised `DomainScaling` of the rest surface. One step of
/// size 1/λ is the implicit Euler step (thesis Eq. 4.22): it solves
///
///   K X + λ W (X − X_{t−1}) = F(X),   F_i = ∫ R_i f(S) du dv   (thesis Eqs. 4.23, 4.25)
///
/// with the forces of the tools taken at the new position, as the minimum of ½ XᵀKX + λ/2 |X − X_{t−1}|²_W + Ψ(X). For
/// that, K + λW is factored once; Newton's iteration treats the springs in contact by conjugate gradients on that
/// factor, with a line search on the minimised function. Hence the step is stable for any stiffness k and λ > 0, and
/// stiffness does not freeze the sheet. Without tools it is exactly one back substitution.
/// Cost of a step: a few evaluations of the surface on the Gauss grid and a few tens of back substitutions while in
/// contact. Immutable, const is thread-safe.
class ActiveSurface {
 public:
  /// Factors the matrices. Errors: a bad material or λ (input), no area, not positive definite (numerical).
  [[nodiscard]] static Expected<ActiveSurface> create(const Surface& rest, const ActiveSettings& settings);

  /// One step from the given control points (file units) under tools given in file units. Errors (numerical): the
  /// result is not finite; nothing is changed then.
  [[nodiscard]] Expected<ActiveStep> step(const Points& control_points, std::span<const Tool> tools) const;

  /// Σ Xᵀ K X of the given control points.
  [[nodiscard]] double energy(const Points& control_points) const;

  [[nodiscard]] const DomainScaling& scaling() const;
  [[nodiscard]] const ActiveSettings& settings() const;
  /// Control points that are free to move.
  [[nodiscard]] int free_count() const;

 private:
  struct Model;
  explicit ActiveSurface(std::shared_ptr<const Model> model) : model_(std::move(model)) {}
  std::shared_ptr<const Model> model_;
};

}  // namespace knead
