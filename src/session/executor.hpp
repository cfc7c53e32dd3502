#pragma once

#include <optional>

#include "knead/session/session.hpp"
#include "surface_model.hpp"

namespace knead {

struct Session::ModelCache {
  std::optional<SurfaceModel> model;
};

/// Applies one command to a copy of the state.
struct Executor {
  const Document& document;
  std::optional<SurfaceModel>& cache;
  SessionState& state;
  const Session::Progress& progress;

  Expected<void> operator()(const NewCommand& c);
  Expected<void> operator()(const SelectCommand& c);
  Expected<void> operator()(const MaterialCommand& c);
  Expected<void> operator()(const RestCommand& c);
  Expected<void> operator()(const ScalingCommand& c);
  Expected<void> operator()(const LoadCommand& c);
  Expected<void> operator()(const LimitCommand& c);

  Expected<void> operator()(const HoldCommand& c);
  Expected<void> operator()(const PinCommand& c);
  Expected<void> operator()(const EdgeCommand& c);
  Expected<void> operator()(const FreezeCommand& c);
  Expected<void> operator()(const KeepCommand& c);
  Expected<void> operator()(const SymmetryCommand& c);
  Expected<void> operator()(const SmoothCommand& c);
  Expected<void> operator()(const SeamsCommand& c);
  Expected<void> operator()(const ReleaseCommand& c);

  Expected<void> operator()(const ToolCommand& c);
  Expected<void> operator()(const RemoveCommand& c);
  Expected<void> operator()(const MoveCommand& c);
  Expected<void> operator()(const TurnCommand& c);
  Expected<void> operator()(const ScaleCommand& c);
  Expected<void> operator()(const ForceCommand& c);

  Expected<void> operator()(const EvolveCommand& c);
  Expected<void> operator()(const StepCommand& c);
  Expected<void> operator()(const StrokeCommand& c);
  Expected<void> operator()(const DragCommand& c);
  Expected<void> operator()(const RelaxCommand& c);
  Expected<void> operator()(const LatticeCommand& c);

  Expected<void> operator()(const PointsCommand& c);
  Expected<void> operator()(const WeightsCommand& c);
  Expected<void> operator()(const KnotsCommand& c);

  Expected<void> operator()(const RefineCommand& c);
  Expected<void> operator()(const ElevateCommand& c);
  Expected<void> operator()(const CoarsenCommand& c);

  Expected<void> operator()(const UndoCommand&) { return {}; }
  Expected<void> operator()(const RedoCommand&) { return {}; }

  /// The first selected surface, or an error that says how to select one.
  Expected<SurfaceState*> selected();
  Expected<int> find_surface(const std::string& id) const;
  Expected<Tool*> find_tool(const std::optional<std::string>& name);
  /// Diagonal of the bounding box of the first selected surface's reference: the unit of `relative`.
  Expected<double> diagonal();

  /// Asks for a constraint on the selected surfaces, after trying that it can be made.
  Expected<void> ask(const ConstraintRequest& request);
  /// Whether a model can be made under the constraints there are.
  Expected<void> check_constraints();

  /// `count` steps with the forces of the scene and these.
  Expected<void> run(int count, const EvolveCommand& evolve, const std::vector<PointForce>& more = {}, int done = 0,
                     int total = 0);
  /// The tools of the scene, and their images in planes of mirror symmetry.
  Expected<std::vector<Tool>> all_tools();
  /// Share `plasticity` of the displacement becomes rest shape.
  Expected<void> yield(double plasticity);

  /// The only selected surface. Error: there are several.
  Expected<SurfaceState*> selected_alone();
  /// The same control points on other knots or with other weights: what has the present shape's basis (all but
  /// perhaps `opened`) gets another one, made by `change` from a shape.
  template <class F>
  Expected<void> change_basis(SurfaceState& surface, const F& change);

  /// Replaces the four shapes of a surface by what `change` makes of them.
  template <class F>
  Expected<void> reshape(SurfaceState& surface, const F& change);
  /// Refines what seams between selected surfaces need.
  Expected<void> refine_seams();
  /// Halves the spans of the selected surfaces that a tool reaches. Returns whether there were any.
  Expected<bool> refine_under(const Tool& tool);
};

}  // namespace knead
