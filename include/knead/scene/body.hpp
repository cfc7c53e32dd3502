#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "knead/scene/constraint.hpp"
#include "knead/scene/elasticity.hpp"
#include "knead/sculpt/active_spline.hpp"
#include "knead/sculpt/body_constraints.hpp"

namespace knead {

// Curves and volumes of a scene. Each is sculpted alone: seams, faces, strokes and brushes are those of surfaces.

/// A side, with the first `order` derivatives across it, as `EdgeHold`.
struct SideHold {
  DomainSide side;
  int order = 0;
  Components components = all_components;
  friend bool operator==(const SideHold&, const SideHold&) = default;
};

/// A point, as `PointPin`.
struct PlacePin {
  std::vector<double> at;          ///< a fraction of the domain for each direction
  std::optional<Vector3> to = {};  ///< its target, file units; left out: where it was
  Components components = all_components;
  friend bool operator==(const PlacePin&, const PlacePin&) = default;
};

using BodyHold = std::variant<SideHold, PlacePin>;

/// A hold and the control points when it was requested, on the present net: what is held stays where it was then.
struct KeptBodyHold {
  BodyHold hold;
  Points where;

  friend bool operator==(const KeptBodyHold& a, const KeptBodyHold& b) {
    return a.hold == b.hold && a.where == b.where;
  }
};

/// The shapes of a body and its material. They share knots and weights.
template <int D>
struct BodyShapes {
  std::shared_ptr<const Spline<D>> opened;     ///< as it was made, on the present net
  std::shared_ptr<const Spline<D>> reference;  ///< defines the units of the model
  std::shared_ptr<const Spline<D>> rest;       ///< displacements are measured from it
  std::shared_ptr<const Spline<D>> current;
  MaterialOf<D> material = {};
  Elasticity<D> elasticity = {};
};

/// A curve or a volume of a scene.
struct SceneBody {
  std::string id, name, unit;
  std::variant<BodyShapes<1>, BodyShapes<3>> shapes;
  Points velocity = {};  ///< of a dynamic evolution; empty: at rest
  RestMode mode = RestMode::shape;
  double mass = 1, damping = 0.5;  ///< per measure of the parameter domain
  int hold_rows = 0;               ///< outer layers of control points that do not move
  std::set<int> pins = {};         ///< control points that do not move
  std::vector<KeptBodyHold> holds = {};

  [[nodiscard]] bool is_curve() const { return shapes.index() == 0; }
};

/// "curve", "volume".
[[nodiscard]] const char* kind_of(const SceneBody& body);

/// Degrees, and numbers of control points, in each direction.
[[nodiscard]] std::vector<int> degrees_of(const SceneBody& body);
[[nodiscard]] std::vector<int> net_of(const SceneBody& body);
[[nodiscard]] const Points& control_points_of(const SceneBody& body);

/// The diagonal of the box of the control points of its reference shape.
[[nodiscard]] double diagonal_of(const SceneBody& body);

/// The largest displacement from the body as it was made, at p + 3 places per span and direction, file units.
[[nodiscard]] double largest_displacement(const SceneBody& body);

/// Number of control points that are not where they were, bit for bit.
[[nodiscard]] int moved_control_points(const SceneBody& body);

/// Every span halved in each direction, the shapes unchanged. Errors (input): control points are pinned by their
/// numbers, which change with the net.
[[nodiscard]] Expected<void> halve_spans(SceneBody& body);

/// The six sides of a volume as surfaces, exact: u0, u1, v0, v1, w0, w1, parametrised by the other two directions such
/// that S_u × S_v points outward where the volume's Jacobian is positive. Errors (input): an end that is not clamped,
/// with what to do.
[[nodiscard]] Expected<std::vector<Surface>> sides_of(const Volume& volume);

}  // namespace knead
