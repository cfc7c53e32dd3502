#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "scene.hpp"

namespace knead {

// What models of surfaces and of bodies take from a scene alike.

/// How steps are made. `detail`: `detail_of` its tools.
template <int D>
void set_evolution(const EvolutionPolicy& evolution, ScalingMode scaling, double detail,
                   ActiveSettings<D>& settings) {
  settings.evolution = evolution.mode;
  settings.weight = evolution.weight;
  settings.lambda = evolution.lambda;
  settings.time_step = evolution.time_step;
  settings.route = evolution.route;
  settings.accuracy = evolution.accuracy;
  settings.solver = evolution.solver;
  settings.energy_tolerance = evolution.energy_tolerance;
  settings.raw = scaling == ScalingMode::raw;
  settings.detail = detail;
}

/// What is worth telling about how steps are solved.
inline void note_engine(const StepEngine& engine, std::vector<std::string>& notes) {
  if (engine.usual) return;
  notes.push_back(
      (engine.iterative ? "steps are solved by iteration: " : "steps are solved by a factor: ") +
      engine.reason);
}

/// A spring or a volcano on the point Σ R X of these terms.
template <PullsAPoint F>
PointForce point_force(const F& f, std::vector<std::pair<int, double>> terms) {
  PointForce force;
  force.terms = std::move(terms);
  force.to = Point(f.to.data());
  force.strength = f.strength;
  if constexpr (std::is_same_v<F, VolcanoForce>) {
    force.kind = PointForce::Kind::volcano;
    force.core = f.core;
  }
  return force;
}

}  // namespace knead
