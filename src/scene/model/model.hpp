#pragma once

#include <span>

#include "brep/shared_edge.hpp"
#include "knead/hold/seams.hpp"
#include "scene/scene.hpp"

namespace knead {

/// What a model depends on in one surface beyond what it depends on in all shapes.
struct VisibleInput {
  bool smooth_knot_lines = true, smooth_poles = true;
  std::shared_ptr<const VisibleRegion> visible;  ///< if edges of faces are held, else null
  std::shared_ptr<const VisibleRegion>
      touched;               ///< where tools touch only what is visible, else null
  std::vector<bool> masked;  ///< control points that a mask holds; empty: none

  friend bool operator==(const VisibleInput&, const VisibleInput&) = default;
};

/// What a model depends on in one shape.
template <int D>
struct ShapeInput : OfSurfaces<D, VisibleInput> {
  std::string id;
  std::shared_ptr<const Spline<D>> reference;
  /// Of surfaces if constraints are measured from it, or loads vary per area; else null.
  std::shared_ptr<const Spline<D>> rest;
  RestMode mode = RestMode::shape;
  MaterialFieldOf<D> material;
  Elasticity<D> elasticity;
  int hold_rows = 0;
  std::set<std::array<int, D>> pins;
  std::vector<KeptConstraintOf<D>> constraints;

  friend bool operator==(const ShapeInput&, const ShapeInput&) = default;
};
using SurfaceInput = ShapeInput<2>;

/// An edge whose faces move together.
struct FollowedInput {
  std::shared_ptr<const SharedEdge> course;
  std::vector<int> patches;  ///< of each of its surfaces: an index into `ModelInput::shapes`

  friend bool operator==(const FollowedInput&, const FollowedInput&) = default;
};

/// What a model of surfaces depends on beyond them.
struct JoiningInput {
  SeamPolicy seams;
  std::vector<FollowedInput> followed = {};
  CouplingTolerance coupling = {};   ///< with followed edges: as `Scene::coupling`
  std::optional<Load> varying = {};  ///< the load, if it varies, since its forces are kept

  friend bool operator==(const JoiningInput&, const JoiningInput&) = default;
};

/// Everything a model of the selected shapes depends on: equal inputs give equal models.
template <int D>
struct ModelInputOf : OfSurfaces<D, JoiningInput> {
  std::vector<ShapeInput<D>> shapes;  ///< the selected ones, in their order
  ScalingMode scaling = ScalingMode::normalised;
  EvolutionPolicy evolution;
  double detail = 0;  ///< smallest tool dimension that forces must resolve, file units; 0: no tool

  friend bool operator==(const ModelInputOf&, const ModelInputOf&) = default;
};
using ModelInput = ModelInputOf<2>;

/// Control points that can be moved together, coupled surfaces all counted: what is factored for
/// more of them would take gigabytes and minutes.
inline constexpr Eigen::Index max_model_size = 1000000;

/// Error (input): surfaces of so many control points in all are more than can be moved together.
[[nodiscard]] Expected<void> check_model_size(Eigen::Index control_points);

/// The smallest dimension of these tools that forces must resolve; 0: none.
[[nodiscard]] double detail_of(const std::vector<Tool>& tools);

/// A large λ, which gives a model of anything that can step: for checks, and for energies, which do
/// not depend on how steps are made.
[[nodiscard]] EvolutionPolicy trial_evolution();

/// The input for the model of the selected shapes of so many directions under this evolution.
template <int D = 2>
[[nodiscard]] ModelInputOf<D> model_input(const Scene& scene, const EvolutionPolicy& evolution);

/// The part of an input that concerns some of its surfaces: among them, the edges that follow whose
/// surfaces are all there, and seams to the tolerance of the whole. \param surfaces ascending
/// indices
[[nodiscard]] ModelInput part_of(const ModelInput& input, std::span<const int> surfaces);

/// Whether some constraint asks a surface to be elsewhere than at rest, so that constraints may
/// contradict each other: the surfaces as they rest meet all others.
[[nodiscard]] bool asks_for_motion(const ModelInput& input);

/// Whether the constraints of a model can be made and met together. Errors: those of `make_model`
/// about constraints, without making a matrix. Cost: one elimination where something asks for
/// motion, else that of making constraints.
[[nodiscard]] Expected<void> check_conditions(const ModelInput& input);

/// A linear model of shapes, whatever their elasticity is, coupled and constrained as requested.
template <int D>
struct SceneModelOf {
  ModelInputOf<D> input;
  ActiveSpline<D> model;
  std::vector<SeamReport> seams;   ///< of surfaces; patches are indices into `input.shapes`
  std::vector<std::string> notes;  ///< lines that may bend, etc.
  /// Forces of the load's samples and formulas on the control points; empty: none.
  Points varying_load = {};
};
using SceneModel = SceneModelOf<2>;

/// Makes and factors the model. `input` has at least one shape.
/// Errors: surfaces of different rest modes, constraints that contradict each other (input), and
/// those of `ActiveSpline::create`.
template <int D>
[[nodiscard]] Expected<SceneModelOf<D>> make_model(ModelInputOf<D> input);

/// Seams between these patches (and of each with itself) to the requested tolerance, or the
/// suggested one.
[[nodiscard]] Expected<FoundSeams> seams_between(const SeamPolicy& policy,
                                                 std::span<const Surface* const> patches);

/// The control points of what is selected, shapes stacked, with their rest shapes and velocities.
[[nodiscard]] ActiveState active_state(const Scene& scene);

/// Loads, point forces with their mirror images, and the limit of the scene. `model` is that of the
/// selected surfaces. Errors (input): a force on a point that does not exist.
[[nodiscard]] Expected<ActiveLoads> active_loads(const Scene& scene, const SceneModel& model);

/// The same on the selected curve or volume. Errors (input): a load that only surfaces have, too.
template <int D>
[[nodiscard]] Expected<ActiveLoads> body_loads(const Scene& scene);

/// Its springs and volcanoes alone, on the control points of the selected surfaces, stacked.
/// Errors: likewise.
[[nodiscard]] Expected<std::vector<PointForce>> active_point_forces(const Scene& scene);

/// The control points of what is selected as opened, shapes stacked.
[[nodiscard]] Points opened_points(const Scene& scene);

/// A model of what is selected in a scene, whatever resists in it: made once, for many steps.
class Model {
 public:
  Model() = default;
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
  virtual ~Model() = default;

  /// Whether it is that of this scene too, in steps that evolve so.
  [[nodiscard]] virtual bool serves(const Scene& scene, const EvolutionPolicy& evolution) const = 0;
  /// Whether `energy` is that of this scene too, however it evolves.
  [[nodiscard]] virtual bool measures(const Scene& scene) const = 0;
  /// What acts on it in the scene besides tools, and these springs. Errors (input): a load or a
  /// force that what resists does not have, or at a point that does not exist.
  [[nodiscard]] virtual Expected<ActiveLoads> loads(
      const Scene& scene, const std::vector<PointForce>& grips = {}) const = 0;
  /// One step from this state (`active_state`), file units. A load of surfaces that are not linear
  /// is put on in so many equal increments in a stationary step. The first step may set up more.
  /// Errors: those of `ActiveSpline::step`, `ActiveShell` or `ActiveForm`.
  [[nodiscard]] virtual Expected<ActiveStep> step(const ActiveState& from,
                                                  std::span<const Tool> tools,
                                                  const ActiveLoads& loads, int increments = 1) = 0;
  [[nodiscard]] virtual double energy(const ActiveState& of) const = 0;

  /// Of surfaces, by their place in the selection.
  [[nodiscard]] virtual std::span<const SeamReport> seams() const { return {}; }
  /// Lines that may bend, how steps are solved, etc.
  [[nodiscard]] virtual std::span<const std::string> notes() const = 0;
  /// Number of control points.
  [[nodiscard]] virtual Eigen::Index size() const = 0;
};

/// The model of what is selected. Errors: surfaces of different kinds, constraints that contradict
/// each other (input), those of `ActiveSpline`, `ShellEnergy` and `FormEnergy`.
[[nodiscard]] Expected<std::unique_ptr<Model>> model_of(const Scene& scene,
                                                        const EvolutionPolicy& evolution);

/// The last models that were made: one that is asked for again is not made again. Some few are
/// kept, or the last one alone where they are large.
class Models {
 public:
  /// The pointer is valid until the next call. Errors: those of `model_of`.
  [[nodiscard]] Expected<Model*> of(const Scene& scene, const EvolutionPolicy& evolution);
  /// One that measures the scene; null: none is kept.
  [[nodiscard]] const Model* measuring(const Scene& scene) const;
  /// The one that was asked for last; null: none is kept.
  [[nodiscard]] const Model* last() const { return kept_.empty() ? nullptr : kept_.front().get(); }

 private:
  std::vector<std::unique_ptr<Model>>
      kept_;  // in the order in which they were asked for, the last one first
};

/// The parts of a load that vary, forces per area over the domain of a surface: that of its
/// samples, and one for each component by formula. Errors: those of `sampled_load` and
/// `formula_field`.
[[nodiscard]] Expected<std::vector<Surface>> load_fields(const Load& load, const Surface& surface);

/// The constraints that one symmetry puts on a surface; terms are numbered by its own control
/// points.
[[nodiscard]] Expected<void> symmetry_constraints(const Surface& reference,
                                                  const EdgeSymmetry& symmetry,
                                                  ConstraintList& list);
[[nodiscard]] Expected<void> symmetry_constraints(const Surface& reference,
                                                  const MirrorSymmetry& symmetry,
                                                  ConstraintList& list);

}  // namespace knead
