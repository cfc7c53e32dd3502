#pragma once

#include <array>
#include <memory>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "constraint.hpp"
#include "elasticity.hpp"
#include "knead/brep/visible_region.hpp"
#include "knead/contact/active_spline.hpp"
#include "knead/energy/material_field.hpp"

namespace knead {

/// What curves and volumes have in place of what surfaces alone have.
struct Nothing {
  friend bool operator==(const Nothing&, const Nothing&) = default;
};
template <int D, class T>
using OfSurfaces = std::conditional_t<D == 2, T, Nothing>;

/// The lasting deformation that tools leave in a surface.
struct PlasticPolicy {
  bool along = false;  ///< strokes leave a groove along their path; else the shape when the tool is
                       ///< lifted remains
  double share = 1;    ///< of a displacement beyond the yield that remains
  double yield = 0;    ///< up to this displacement nothing remains
  double locality = 0;   ///< how far a dent extends; 0: as far as the evolution lets it
  bool in_radii = true;  ///< yield and locality count sizes of the tool; false: file units

  friend bool operator==(const PlasticPolicy&, const PlasticPolicy&) = default;
};

/// What a shape of a scene has, however many directions it has.
struct ShapeCommon {
  std::string id, name, unit;
  Points velocity = {};  ///< of a dynamic evolution, a spline on the present net; empty: at rest
  RestMode mode = RestMode::shape;
  int hold_rows = 0;  ///< outer layers of control points that do not move
};

/// Its shapes, what resists in them, and what is held. `reference`, `rest` and `current` share
/// their knots and weights, as does `opened` unless they were edited since; the domain is always
/// the same.
template <int D>
struct ShapeOf {
  std::shared_ptr<const Spline<D>>
      opened;  ///< as opened or made, on the present net if it has the present basis
  std::shared_ptr<const Spline<D>> reference;  ///< defines the units of the model
  std::shared_ptr<const Spline<D>> rest;       ///< displacements are measured from it
  std::shared_ptr<const Spline<D>> current;
  MaterialFieldOf<D> material = {};
  Elasticity<D> elasticity = {};
  std::set<std::array<int, D>> pins = {};  ///< control points that do not move
  std::vector<KeptConstraintOf<D>> constraints = {};
};

/// What surfaces alone have.
struct SurfaceOwn {
  bool locked = false;  ///< it is not selected, so that nothing moves it
  bool smooth_knot_lines = true, smooth_poles = true;
  PlasticPolicy plastic = {};
  /// Of each control point the share by which strokes and brushes move it less, 0 to 1; what has 1
  /// is held. Empty: none.
  std::vector<double> mask = {};
  /// The part of it that faces show, in fractions of its domain; null until first needed.
  std::shared_ptr<const VisibleRegion> visible = {};
};

/// A shape of a scene.
template <int D>
struct SceneShape : ShapeCommon, ShapeOf<D>, OfSurfaces<D, SurfaceOwn> {};
using SceneCurve = SceneShape<1>;
using SceneSurface = SceneShape<2>;
using SceneVolume = SceneShape<3>;

/// A shape as it is opened or made: nothing has moved it yet.
template <int D>
[[nodiscard]] SceneShape<D> untouched(std::string id, std::string name, std::string unit,
                                      std::shared_ptr<const Spline<D>> spline) {
  SceneShape<D> shape;
  shape.id = std::move(id);
  shape.name = std::move(name);
  shape.unit = std::move(unit);
  shape.opened = shape.reference = shape.rest = shape.current = std::move(spline);
  return shape;
}

/// A curve or a volume. Each is sculpted alone: seams, faces, strokes and brushes are those of
/// surfaces.
using SceneBody = std::variant<SceneCurve, SceneVolume>;

/// "curve", "surface", "volume".
[[nodiscard]] const char* kind_of(int directions);
[[nodiscard]] const char* kind_of(const SceneBody& body);

[[nodiscard]] const ShapeCommon& common_of(const SceneBody& body);
/// Degrees, and numbers of control points, in each direction.
[[nodiscard]] std::vector<int> degrees_of(const SceneBody& body);
[[nodiscard]] std::vector<int> net_of(const SceneBody& body);
[[nodiscard]] const Points& control_points_of(const SceneBody& body);

/// The diagonal of the box of the control points of its reference shape.
[[nodiscard]] double diagonal_of(const SceneBody& body);

/// The largest displacement from the body as it was made, at p + 3 places per span and direction,
/// file units.
[[nodiscard]] double largest_displacement(const SceneBody& body);

/// Number of control points that are not where they were, bit for bit.
[[nodiscard]] int moved_control_points(const SceneBody& body);

/// Every span halved in each direction, the shapes unchanged. Errors (input): control points are
/// pinned by their numbers, which change with the net.
[[nodiscard]] Expected<void> halve_spans(SceneBody& body);

/// The six sides of a volume as surfaces, exact: u0, u1, v0, v1, w0, w1, parametrised by the other
/// two directions such that S_u × S_v points outward where the volume's Jacobian is positive.
/// Errors (input): an end that is not clamped, with what to do.
[[nodiscard]] Expected<std::vector<Surface>> sides_of(const Volume& volume);

}  // namespace knead
