#pragma once

#include <variant>

#include "knead/scene/scene.hpp"

namespace knead {

/// What a model of a body depends on, as `ModelInput`.
template <int D>
struct BodyInput {
  std::string id;
  std::shared_ptr<const Spline<D>> reference, rest;
  RestMode mode = RestMode::shape;
  MaterialOf<D> material;
  Elasticity<D> elasticity;
  double mass = 1, damping = 0.5;
  int hold_rows = 0;
  std::set<int> pins;
  std::vector<KeptBodyHold> holds;
  ScalingMode scaling = ScalingMode::normalised;
  EvolutionPolicy evolution;
  double detail = 0;

  friend bool operator==(const BodyInput&, const BodyInput&) = default;
};

/// The selected body, if it has so many directions.
template <int D>
[[nodiscard]] const SceneBody* selected_body(const Scene& scene) {
  if (!scene.body) return nullptr;
  const SceneBody& body = scene.bodies[static_cast<std::size_t>(*scene.body)];
  return std::holds_alternative<BodyShapes<D>>(body.shapes) ? &body : nullptr;
}

template <int D>
[[nodiscard]] BodyInput<D> body_input(const Scene& scene, const SceneBody& body, const EvolutionPolicy& evolution);

/// A linear model of one body, constrained as requested.
template <int D>
struct BodyModel {
  BodyInput<D> input;
  ActiveSpline<D> model;
  std::vector<std::string> notes;  ///< corners that may bend, etc.
};

/// Makes and factors the model. Errors: constraints that contradict each other (input), and those of
/// `ActiveSpline::create`.
template <int D>
[[nodiscard]] Expected<BodyModel<D>> make_body_model(BodyInput<D> input);

/// What holds a body, as conditions on displacements from its rest shape, file units. Appends notes.
template <int D>
[[nodiscard]] Expected<std::vector<LinearConstraint>> body_conditions(const BodyInput<D>& input, const Points& present,
                                                                      std::vector<std::string>& notes);

/// The control points of a body with its rest shape and velocity.
[[nodiscard]] ActiveState active_state(const SceneBody& body);

/// Loads and point forces of the scene on the body of this index, and the limit. Errors (input): a load that only
/// surfaces have, a force on a point that does not exist.
[[nodiscard]] Expected<ActiveLoads> body_loads(const Scene& scene, int index);

}  // namespace knead
