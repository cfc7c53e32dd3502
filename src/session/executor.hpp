#pragma once

#include <optional>

#include "knead/scene/model.hpp"
#include "knead/scene/reshape.hpp"
#include "knead/session/session.hpp"

namespace knead {

struct Session::ModelCache {
  std::optional<SceneModel> model;
};

/// Applies one command to a copy of the state, and has what commands share. Each command's file defines `execute` for
/// its fields.
struct Executor {
  const Document& document;
  std::optional<SceneModel>& cache;
  SessionState& state;
  const Session::Progress& progress;

  template <class C>
  Expected<void> execute(const C& command);

  /// The first selected surface, or an error that says how to select one.
  Expected<SceneSurface*> selected();
  /// The only selected surface. Error: there are several.
  Expected<SceneSurface*> selected_alone();
  Expected<int> find_surface(const std::string& id) const;
  Expected<Tool*> find_tool(const std::optional<std::string>& name);
  /// Diagonal of the bounding box of the first selected surface's reference: the unit of `relative`.
  Expected<double> diagonal();

  /// Keeps a constraint on the selected surfaces, after trying that it can be made.
  Expected<void> keep(const Constraint& constraint);
  /// Whether a model can be made under the constraints there are.
  Expected<void> check_constraints();

  /// `count` steps with the forces of the scene and these.
  Expected<void> run(int count, const EvolutionPolicy& evolution, const std::vector<PointForce>& more = {},
                     int done = 0, int total = 0);
  /// Share `plasticity` of the displacement becomes rest shape.
  Expected<void> yield(double plasticity);

  /// The same control points on other knots or with other weights. Errors: a limit is set (input), and those of
  /// `change`.
  Expected<void> change_basis(SceneSurface& surface, const SurfaceChange& change);
  /// The same shapes on another net, which is noted.
  Expected<void> change_net(SceneSurface& surface, const SurfaceChange& change);
  /// Refines what seams between selected surfaces need.
  Expected<void> refine_seams();
  /// Halves the spans of the selected surfaces that a tool reaches. Returns whether there were any.
  Expected<bool> refine_under(const Tool& tool);

 private:
  Expected<void> prepare_model(const EvolutionPolicy& evolution);
  Expected<ActiveStep> one_step(const std::vector<PointForce>& more, double& seconds);
  Expected<void> take(const ActiveStep& step);
  void record(const ActiveStep& step, double seconds, std::string note);
  void note_model();
};

/// "#12: the net is now …", for the notes.
[[nodiscard]] std::string net_note(const SceneSurface& surface);

}  // namespace knead
