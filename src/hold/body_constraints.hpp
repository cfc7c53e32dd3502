#pragma once

#include <array>
#include <optional>
#include <vector>

#include "knead/hold/constraints.hpp"

/// Design constraints on curves and volumes, in the manner of hold/constraints.hpp: every
/// function appends to a `ConstraintList` conditions on the displacements X_i of the control
/// points.
namespace knead {

/// One side of a parameter domain: an end of a curve, a face of a volume.
struct DomainSide {
  int direction = 0;
  bool upper = false;  ///< where the parameter is largest

  friend bool operator==(const DomainSide&, const DomainSide&) = default;
};

/// "u0", "w1".
[[nodiscard]] std::string side_name(DomainSide side);

/// Keeps a side and the derivatives of the displacement across it up to `order`: 0 the side itself,
/// 1 also its tangents, 2 also its curvatures.
///
/// Where the end is clamped, the order + 1 layers of control points next to it are held; elsewhere
/// Σ_i N_i^(k)(c) w_ij X_ij = 0 for every j and k = 0 … order, the condition that the numerator of
/// the displacement and its derivatives vanish along the side. Errors (input): a direction that
/// does not exist, an order that is not 0 to 2.
template <int D>
Expected<void> hold_side(const Spline<D>& rest, DomainSide side, int order, ConstraintList& to);

/// Holds the point at `u` at `place`, or where it is at rest: Σ R_i(u) X_i = place − S(u). Errors
/// (input): a place that is not finite; (numerical): a denominator that is not positive. Requires:
/// u in the domain (asserted).
template <int D>
Expected<void> pin_place(const Spline<D>& rest, const std::array<double, D>& u,
                         const std::optional<Point>& place, ConstraintList& to);

/// A parameter of a curve at which the basis alone does not keep it smooth.
struct SmoothKnot {
  enum class State {
    coupled,  ///< the curve keeps the continuity that it has at rest
    crease,   ///< it has a corner here at rest, or degree 1, and may bend freely
    torn,     ///< the two sides lie apart at rest; left free
  };
  double knot = 0;
  bool closing = false;  ///< it is where a closed curve begins and ends
  State state = State::crease;
};

/// No hinges: where a curve is tangent-continuous at rest at an interior knot of multiplicity p or
/// p + 1, or where it closes, its deformed shape is tangent-continuous too.
///
/// With ± the two sides, D⁺ = D⁻ where the basis tears, and D_u⁺ = λ D_u⁻ with the λ of S_u⁺ = λ
/// S_u⁻ at rest; both are linear in X, Σ_i (R_i'⁺ − λ R_i'⁻) X_i = 0, exact for rational curves
/// too. Directions that differ by more than `angle` (radian) are a corner, sides further apart than
/// `gap` (of the diagonal of the control points) torn. Returns all such knots, ascending, the
/// closing one last.
Expected<std::vector<SmoothKnot>> keep_smooth_knots(const Curve& rest, const SmoothOptions& options,
                                                    ConstraintList& to);

}  // namespace knead
