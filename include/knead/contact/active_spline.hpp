#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "knead/brep/visible_region.hpp"
#include "knead/energy/domain_scaling.hpp"
#include "knead/energy/loads.hpp"
#include "knead/energy/material_field.hpp"
#include "knead/gramian/gramian.hpp"
#include "knead/solve/eigenmodes.hpp"
#include "knead/solve/linear_constraint.hpp"
#include "knead/tool/tool.hpp"

namespace knead {

/// What the energy acts on.
enum class RestMode {
  shape,  ///< the displacement from the rest shape: nothing moves at rest (the default for CAD
          ///< files)
  none,   ///< the shape itself, as in the thesis: without forces it shrinks to a point
};

/// The weight W of the implicit Euler step.
enum class StepWeight {
  mass,      ///< the mass matrix: refining the net does not change the evolution
  identity,  ///< the identity, thesis Eq. 4.22: the evolution depends on the net
};

/// What a step solves.
enum class Evolution {
  acm,         ///< (K + λW) X = λW X₀ + F, thesis Eq. 4.22: relaxes towards equilibrium
  stationary,  ///< K X = F: equilibrium in one step
  dynamic,     ///< M Ẍ + D Ẋ + K X = F, thesis Eq. 5.39: oscillates
};

/// How the forces of tools are integrated; docs/materials-and-loads.md compares them.
enum class ForceRoute {
  gauss,     ///< by Gauss quadrature: forces have a potential
  analytic,  ///< interpolated at Greville abscissae, then the exact mass matrix (see
             ///< `GrevilleForce`)
};

/// How exactly a step is solved. Errors are those of the displacement Y of the step in the energy
/// norm, √(YᵀAY), and of the forces in its dual, √(gᵀA⁻¹g).
enum class StepAccuracy {
  exact,        ///< to 1e-11 of the forces that the step balances
  interactive,  ///< to `interactive_accuracy` of the displacement of the step
};

inline constexpr double interactive_accuracy = 1e-6;

/// How the linear systems of a step are solved.
enum class StepSolver {
  automatic,  ///< by counts and structure, see `StepEngine`
  direct,     ///< A is factored
  iterative,  ///< conjugate gradients on cycles of multigrid over nested nets (docs/multigrid.md)
};

/// How the systems of a model are solved, and why so.
struct StepEngine {
  bool iterative = false;
  bool usual = true;   ///< what nets of ordinary size get; else worth telling
  std::string reason;  ///< "asked for", or the counts that decided
};

/// Everything that determines the matrices of an `ActiveSpline`, and how its steps are solved.
template <int D>
struct ActiveSettings {
  MaterialOf<D> material;
  RestMode rest = RestMode::shape;
  Evolution evolution = Evolution::acm;
  StepWeight weight = StepWeight::mass;
  double lambda = 1;        ///< acm: inverse step size
  double time_step = 0.02;  ///< dynamic
  double mass = 1;          ///< μ, per measure of the parameter domain
  double damping = 0.5;     ///< γ, force per velocity and measure
  /// Coefficients, mass and damping that vary, one per patch; empty: the constants above.
  std::vector<MaterialFieldOf<D>> fields = {};
  std::vector<bool> held;  ///< control points that do not move, one flag each; empty: none
  std::vector<LinearConstraint>
      constraints;  ///< on the displacements from the rest shape, file units
  /// Of each patch, the part that tools touch which are `ToolTouch::visible`; empty or null: all of
  /// it. Surfaces only, and the Gauss route: on the analytic one tools touch everything.
  std::vector<std::shared_ptr<const VisibleRegion>> visible = {};
  double detail = 0;  ///< smallest tool dimension the forces must resolve, file units; 0: no tool
  ForceRoute route = ForceRoute::gauss;
  bool raw = false;  ///< no normalisation: the equations are taken on the knots as they are
  GramianMethod method = default_gramian_method;
  StepAccuracy accuracy = StepAccuracy::exact;
  StepSolver solver = StepSolver::automatic;
  /// Of rational patches, see `StiffnessOptions`.
  double energy_tolerance = default_rational_tolerance;

  friend bool operator==(const ActiveSettings&, const ActiveSettings&) = default;
};

/// The state of an active spline, in file units (per unit of time). Rows are control points, patch
/// after patch.
struct ActiveState {
  Points control_points;
  Points rest = {};      ///< the rest shape; empty: the one the model was created with
  Points velocity = {};  ///< dynamic; empty: at rest
  /// Stress and loads are taken to balance in this state, whatever they are: only tools move it,
  /// against K + λW from here (acm and stationary).
  bool balanced = false;
  /// Initial guess of a balanced step, or of any of an `ActiveShell`, as a displacement from
  /// `control_points` that the constraints allow: for a moving tool, the previous step; empty:
  /// none.
  Points guess = {};
};

/// A force on one material point S = Σ c X (thesis Eq. 4.24; Kass, Witkin and Terzopoulos 1988).
struct PointForce {
  enum class Kind {
    spring,   ///< ψ = k/2 |S − to|²
    volcano,  ///< ψ = k / √(|S − to|² + core²): repels with k/r² outside the core
  };
  Kind kind = Kind::spring;
  std::vector<std::pair<int, double>> terms;  ///< (control point, R) over all patches
  Point to = Point::Zero();                   ///< file units
  double strength = 1;                        ///< k, in the model's units
  double core = 0.1;                          ///< file units
};

/// Forces other than those of tools. Of an `ActiveSpline` they are per measure of the (scaled)
/// parameter domain, of an `ActiveShell` or `ActiveForm` in units of the file and per area of the
/// present shape.
struct ActiveLoads {
  Point gravity = Point::Zero();  ///< acceleration: force μ·gravity; of an `ActiveSpline` only
  Point force = Point::Zero();    ///< the same everywhere; of an `ActiveSpline` only
  double pressure = 0;  ///< along the normal S_u × S_v at the start of the step; surfaces only
  Point wind = Point::Zero();  ///< (n·(wind − velocity)) n at the start of the step; surfaces only
  Points nodal = {};           ///< ∫ R_i f of any other load, N × 3; empty: none
  /// Which follow their edges; of an `ActiveShell` only, rows are all of its own.
  std::vector<EdgeMoment> moments = {};
  std::vector<PointForce> points = {};
  double limit = 0;  ///< no point moves further than this from `original`, file units; 0: no limit
  Points original = {};  ///< control points the limit is measured from; empty: the rest shape
  /// Without a limit: how far from `original` tools are to move anything, file units; 0: as far as
  /// it goes. Springs that are `reach_stiffness` times those of the stiffest tool hold what goes
  /// further, which is a few per cent. Of an `ActiveSpline` only.
  double reach = 0;
};

/// One step of an `ActiveSpline`.
struct ActiveStep {
  Points control_points;  ///< file units; rows that did not move keep their bits
  Points velocity;        ///< dynamic: file units per unit of time; else empty
  /// Σ Xᵀ K X after the step (thesis Eq. 4.14), normalised units: stretch + bend.
  double energy = 0;
  double stretch = 0, bend = 0;
  double kinetic = 0;  ///< ½ Σ Vᵀ M V
  double contact = 0;  ///< Ψ, the potential of tools, friction and limit
  /// Imbalance of forces at the free unknowns, relative to the forces of tools, loads, free part
  /// and held part of the net acting there: 0 in equilibrium.
  double residual = 0;
  double gap = 0;  ///< deepest penetration of a collision tool, in its sizes: soft ones at Gauss
                   ///< points, rigid ones anywhere
  std::string gap_tool;   ///< its name
  double coarseness = 0;  ///< longest span in contact with a tool, in sizes of that tool
  double violation = 0;   ///< of the constraints, file units
  /// With rational patches: the largest error of an entry of stretch, bend or mass, relative to its
  /// diagonal
  /// (`Stiffness::error_bound`).
  std::optional<double> energy_error = {};
  bool limited = false;   ///< the limit restrains some point
  int iterations = 0;     ///< Newton iterations
  int solves = 0;         ///< back substitutions with the factored matrix
  bool converged = true;  ///< the step's minimum was reached, and the gap of rigid tools met
  std::string note;       ///< why not, and what would help
  /// Of shells that are loaded in parts: the share of the load that is balanced, and Newton's
  /// iterations of each part.
  std::optional<double> load_factor = {};
  std::vector<int> increments = {};
};

/// A spline that resists stretch and bend, deformed by tools: the active model of thesis chapters 4
/// and 5, for curves, surfaces and volumes, with one patch or several coupled by constraints.
///
/// The unknown is X, the displacement of the control points from the rest shape (`RestMode::shape`)
/// or the control points about a fixed origin (`RestMode::none`), in units of a normalised
/// `DomainScaling` of the first patch. A step minimises
///
///   Φ(Y) = ½ YᵀAY − Yᵀb + Ψ(X₀ + Y)
///
/// over all Y = X − X₀ that the constraints allow, with the forces F = −∇Ψ of the tools taken at
/// the new position:
///   acm         A = K + λW,           b = G − K X₀      (implicit Euler)
///   stationary  A = K,                b = G − K X₀
///   dynamic     A = K + D/τ + M/τ²,   b = G − K X₀ + M(Δ/τ² + V₀/τ) + DΔ/τ
/// G the loads, F_i = ∫ R_i f(S) du dv (thesis Eqs. 4.23, 4.25). A dynamic step of size h is two
/// such stages, τ = (1 − √½)h: the L-stable, stiffly accurate diagonally implicit Runge-Kutta
/// method of second order (Alexander 1977). Being A-stable, it never lets ½VᵀMV + ½XᵀKX grow
/// without forces, whatever h; waves much shorter than a step die out instead of ringing. A is
/// factored once; Newton's iteration treats the springs in contact by conjugate gradients on that
/// factor, with a line search on Φ. Hence a step is stable for any stiffness k and step size, and
/// stiffness does not freeze the sheet. Without tools it is exactly one back substitution. The
/// analytic force route, which has no potential, is a lagged correction of the Gauss forces,
/// iterated until it settles; where it does not (stiff contact on a coarse net) the Gauss forces
/// stand and the step's note says so. Immutable, const is thread-safe.
template <int D>
class ActiveSpline {
 public:
  /// Factors the matrices. Errors: a bad material or step size, contradictory constraints (input);
  /// no area, not positive definite, or a stationary problem that nothing holds (numerical).
  [[nodiscard]] static Expected<ActiveSpline> create(std::vector<Spline<D>> patches,
                                                     const ActiveSettings<D>& settings);
  [[nodiscard]] static Expected<ActiveSpline> create(const Spline<D>& rest,
                                                     const ActiveSettings<D>& settings) {
    return create(std::vector<Spline<D>>{rest}, settings);
  }

  /// One step under tools given in file units. Errors (numerical): the result is not finite or
  /// diverges; nothing changes then.
  [[nodiscard]] Expected<ActiveStep> step(const ActiveState& state, std::span<const Tool> tools,
                                          const ActiveLoads& loads = {}) const;
  [[nodiscard]] Expected<ActiveStep> step(const Points& control_points,
                                          std::span<const Tool> tools) const {
    return step(ActiveState{control_points}, tools);
  }

  /// Σ Xᵀ K X of the given control points.
  [[nodiscard]] double energy(const Points& control_points) const {
    return energy(ActiveState{control_points});
  }
  [[nodiscard]] double energy(const ActiveState& state) const;

  /// The displacement that the constraints allow with the same independent unknowns as this one:
  /// held points stay.
  [[nodiscard]] Points allowed(const Points& displacement) const;
  /// argmin ½ (x − d)ᵀ A (x − d) over the displacements x that the constraints allow: near what is
  /// held d gives way smoothly, as far as a dent is felt. Cost: a back substitution.
  [[nodiscard]] Points nearest_allowed(const Points& displacement) const;
  /// The displacement of one step of these control points as they relax without a rest shape, by A
  /// x = −K S: S + x minimises ½ S'ᵀ K S' + λ/2 |S' − S|² over all that the constraints allow.
  /// Cost: a back substitution.
  [[nodiscard]] Points fairing(const Points& control_points) const;

  /// The `vibration_modes` of K and M on all that the constraints leave free, in normalised units;
  /// shapes are of all patches. Errors: those of `vibration_modes`.
  [[nodiscard]] Expected<std::vector<Eigenmode>> modes(int count) const;

  [[nodiscard]] const DomainScaling<D>& scaling(int patch = 0) const;
  [[nodiscard]] const ActiveSettings<D>& settings() const;
  [[nodiscard]] const StepEngine& engine() const;
  /// First row of every patch in the control points, and the end.
  [[nodiscard]] const std::vector<int>& rows() const;
  /// Unknowns that are free to move: control points, or coordinates where a constraint couples
  /// them.
  [[nodiscard]] int free_count() const;

 private:
  struct Model;
  struct Run;
  explicit ActiveSpline(std::shared_ptr<const Model> model) : model_(std::move(model)) {}
  std::shared_ptr<const Model> model_;
};

using ActiveSurface = ActiveSpline<2>;

}  // namespace knead
