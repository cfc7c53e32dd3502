#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hold/body_constraints.hpp"
#include "knead/hold/constraints.hpp"

namespace knead {

using Vector3 = std::array<double, 3>;
/// A place in the parameter domain, (s, t) from 0 to 1.
using Fractions = std::array<double, 2>;
/// A rectangle of the parameter domain in fractions: [s0, s1] × [t0, t1].
using FractionBox = std::array<Fractions, 2>;

/// One edge of a surface, or all four.
enum class EdgeChoice { all, u0, u1, v0, v1 };

/// The edges that a choice stands for.
[[nodiscard]] std::vector<SurfaceEdge> edges_of(EdgeChoice which);

/// Which coordinates, x, y and z, are held.
using Components = std::array<bool, 3>;
inline constexpr Components all_components = {true, true, true};

// Constraints that hold a shape. Each is stored with the shape when it was requested
// (`KeptConstraintOf`): what is held stays where it was then.

/// An edge of a surface, with the first `order` derivatives across it: 0 its position, 1 also its
/// tangent planes, 2 also its curvatures.
struct EdgeHold {
  SurfaceEdge edge = SurfaceEdge::u0;
  int order = 0;
  Components components = all_components;
  friend bool operator==(const EdgeHold&, const EdgeHold&) = default;
};

/// A side of a curve or a volume, as `EdgeHold`.
struct SideHold {
  DomainSide side;
  int order = 0;
  Components components = all_components;
  friend bool operator==(const SideHold&, const SideHold&) = default;
};

/// A point.
template <int D>
struct PointPinOf {
  std::array<double, D> at = {};   ///< a fraction of the domain for each direction
  std::optional<Vector3> to = {};  ///< its target, file units; left out: where it was
  Components components = all_components;
  friend bool operator==(const PointPinOf&, const PointPinOf&) = default;
};
using PointPin = PointPinOf<2>;

/// A whole region, rounded outward to whole spans.
struct Freeze {
  FractionBox region = {{{0, 1}, {0, 1}}};
  friend bool operator==(const Freeze&, const Freeze&) = default;
};

/// A curve of the surface: an isoparametric line, or a polyline of (s, t).
struct Keep {
  std::optional<double> u = {}, v = {};  ///< the line at this fraction of the domain
  std::vector<Fractions> curve = {};
  double tolerance = 1e-6;  ///< for a polyline, as a share of the motion around it
  friend bool operator==(const Keep&, const Keep&) = default;
};

/// Half a symmetric model: edges stay in a plane and the surface perpendicular to it.
struct EdgeSymmetry {
  EdgeChoice which = EdgeChoice::all;
  MirrorPlane plane = {};
  friend bool operator==(const EdgeSymmetry&, const EdgeSymmetry&) = default;
};

/// A whole surface that stays its own mirror image.
struct MirrorSymmetry {
  int direction = 0;  ///< 0: S(u, v) and S(a + b − u, v) are partners; 1 likewise in v
  std::optional<MirrorPlane> plane = {};  ///< left out: the best one
  friend bool operator==(const MirrorSymmetry&, const MirrorSymmetry&) = default;
};

/// All edges of the faces on the surface, with the first `order` derivatives across them, as
/// `EdgeHold`.
struct TrimHolds {
  int order = 0;  ///< −1: they are free on purpose, and may open
  friend bool operator==(const TrimHolds&, const TrimHolds&) = default;
};

/// One edge of the faces on the surface, by its id in the file; overrides `TrimHolds`.
struct TrimEdgeHold {
  std::string id;
  int order = 0;        ///< −1: free
  bool follow = false;  ///< with −1: its faces move together, and the edge with them
  friend bool operator==(const TrimEdgeHold&, const TrimEdgeHold&) = default;
};

namespace detail {
template <int D>
struct ConstraintKinds {  // of curves and volumes
  using type = std::variant<SideHold, PointPinOf<D>>;
};
template <>
struct ConstraintKinds<2> {
  using type = std::variant<EdgeHold, PointPin, Freeze, Keep, EdgeSymmetry, MirrorSymmetry,
                            TrimHolds, TrimEdgeHold>;
};
}  // namespace detail

template <int D>
using ConstraintOf = typename detail::ConstraintKinds<D>::type;
using Constraint = ConstraintOf<2>;

/// A constraint and the shape when it was requested, on the present net.
template <int D>
struct KeptConstraintOf {
  ConstraintOf<D> constraint;
  std::shared_ptr<const Spline<D>> where;

  friend bool operator==(const KeptConstraintOf&, const KeptConstraintOf&) = default;
};
using KeptConstraint = KeptConstraintOf<2>;

/// The plane of a mirror symmetry of this surface: as given, or the best one. Errors: those of
/// `mirror_plane`.
[[nodiscard]] Expected<MirrorPlane> plane_of(const MirrorSymmetry& symmetry,
                                             const Surface& surface);

/// The control point that is the mirror image of control point (i, j) of a net.
[[nodiscard]] std::array<int, 2> mirror_image(const MirrorSymmetry& symmetry,
                                              const std::array<int, 2>& net,
                                              const std::array<int, 2>& point);

}  // namespace knead
