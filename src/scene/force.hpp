#pragma once

#include <string>
#include <variant>
#include <vector>

#include "constraint.hpp"

namespace knead {

// What acts on one point or one edge of a shape until it is removed (thesis Eq. 4.24). Points are
// fractions of the domain, one for each direction.

/// Draws the point to a place: ψ = k/2 |S − to|².
struct SpringForce {
  std::vector<double> at;
  Vector3 to = {};       ///< file units
  double strength = 10;  ///< k, in units of the model
  friend bool operator==(const SpringForce&, const SpringForce&) = default;
};

/// Drives it away from there: ψ = k / √(|S − to|² + core²).
struct VolcanoForce {
  std::vector<double> at;
  Vector3 to = {};
  double strength = 10;
  double core = 0.1;  ///< within this distance it stops growing, file units
  friend bool operator==(const VolcanoForce&, const VolcanoForce&) = default;
};

/// The same force whatever the point does.
struct DeadForce {
  std::vector<double> at;
  Vector3 vector = {};
  friend bool operator==(const DeadForce&, const DeadForce&) = default;
};

/// A dead force along edges of a surface.
struct LineForce {
  EdgeChoice edge = EdgeChoice::all;
  Vector3 vector = {};  ///< per length of the rest shape
  friend bool operator==(const LineForce&, const LineForce&) = default;
};

/// Turns a shell about edges, wherever they go (`EdgeMoment`).
struct MomentForce {
  EdgeChoice edge = EdgeChoice::all;
  double moment = 0;  ///< per length of the rest shape
  friend bool operator==(const MomentForce&, const MomentForce&) = default;
};

using Force = std::variant<SpringForce, VolcanoForce, DeadForce, LineForce, MomentForce>;

/// Forces whose direction follows from where the point is.
template <class F>
concept PullsAPoint = requires(const F& f) {
  f.to;
};

/// A force of a scene.
struct SceneForce {
  std::string name = "force";
  int surface = 0;  ///< index into the scene's surfaces; −1: it acts on a body
  int body = -1;    ///< index into the scene's bodies; −1: it acts on a surface
  Force force;

  [[nodiscard]] bool pulls_a_point() const {
    return std::visit([]<class F>(const F&) { return PullsAPoint<F>; }, force);
  }
  [[nodiscard]] bool keeps_direction() const {
    return std::holds_alternative<DeadForce>(force) || std::holds_alternative<LineForce>(force);
  }

  friend bool operator==(const SceneForce&, const SceneForce&) = default;
};

}  // namespace knead
