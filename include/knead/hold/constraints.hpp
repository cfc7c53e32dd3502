#pragma once

#include <optional>
#include <string>
#include <vector>

#include "knead/solve/linear_constraint.hpp"
#include "knead/spline/evaluate.hpp"

/// Design constraints on a surface, as linear conditions on the displacements X_ij of its control
/// points.
///
/// The displacement field of a surface with weights w is D = B/W with B = Σ w_ij N_i M_j X_ij and W
/// = Σ w_ij N_i M_j (w = 1 where there are none). Every function here appends to a `ConstraintList`
/// the conditions that make its promise hold for D, exactly up to rounding unless it says
/// otherwise; control points that must not move at all become held flags and keep their bits. Rows
/// refer to one surface; index (i, j) is unknown i n + j as in `Spline`. Errors of all of them: a
/// parameter outside the domain or not finite, an order that is not 0 to 2, a tolerance that is not
/// a finite number >= 0 (input); a denominator W that is not positive where it divides (numerical).
/// On an error the list is unchanged.
namespace knead {

/// A boundary isocurve of a surface: u at the start or end of its domain, or v.
enum class SurfaceEdge { u0, u1, v0, v1 };

[[nodiscard]] constexpr const char* edge_name(SurfaceEdge edge) {
  constexpr const char* names[] = {"u0", "u1", "v0", "v1"};
  return names[static_cast<int>(edge)];
}
/// The direction across the edge: 0 for u0 and u1, along which v runs.
[[nodiscard]] constexpr int edge_across(SurfaceEdge edge) { return static_cast<int>(edge) / 2; }
/// The direction that runs along the edge.
[[nodiscard]] constexpr int edge_along(SurfaceEdge edge) { return 1 - edge_across(edge); }
[[nodiscard]] constexpr bool edge_at_end(SurfaceEdge edge) {
  return static_cast<int>(edge) % 2 == 1;
}

/// The constraints on one surface so far; `held` and `constraints` go into `ActiveSettings`.
struct ConstraintList {
  std::vector<bool> held;            ///< control points that do not move, one flag each
  std::vector<std::string> held_by;  ///< for each, the name of the first that holds it
  std::vector<LinearConstraint>
      constraints;  ///< on the displacements, file units; the largest coefficient is 1 or less

  explicit ConstraintList(int size)
      : held(static_cast<std::size_t>(size)), held_by(static_cast<std::size_t>(size)) {}
  void hold(int i, const std::string& name);
};

/// Makes the constraints from number `first` on hold their points at the present position, not the
/// rest position: their right sides become Σ c X of the present displacements. For held edges,
/// lines, points and curves.
void keep_present(ConstraintList& list, const Points& displacement, std::size_t first = 0);

/// Keeps the isoparametric line u = c (direction 0) or v = c (direction 1), and the derivatives of
/// D across it up to `order`: 0 the line, 1 also its tangent planes, 2 also its curvatures.
///
/// Σ_i N_i^(k)(c) w_ij X_ij = 0 for every j and k = 0 … order: the condition that B and its
/// derivatives, and hence D and its derivatives, vanish along the whole line, on both sides where
/// the basis is less smooth than that at c. Where c has multiplicity p (a clamped end), this holds
/// order + 1 rows of control points.
Expected<void> hold_isoline(const Surface& rest, int direction, double c, int order,
                            ConstraintList& to);

/// The same for an edge: position, `order` 1 clamped, 2 curvature.
Expected<void> hold_edge(const Surface& rest, SurfaceEdge edge, int order, ConstraintList& to);

/// Holds the surface point (u, v) at `place`, or where it is at rest: Σ R_ij(u, v) X_ij = place −
/// S(u, v). Where a knot of multiplicity p + 1 tears the surface at (u, v), the points on all
/// sides.
Expected<void> pin_point(const Surface& rest, double u, double v, const std::optional<Point>& place,
                         ConstraintList& to);

/// The part of the parameter domain that does not move.
struct FrozenRegion {
  Interval u, v;
};

/// Freezes the rectangle u × v, rounded outward to whole spans: holds all control points whose
/// basis functions are non-zero on them. Interval ends may coincide: then the span to the right is
/// taken (to the left at the end of the domain).
Expected<FrozenRegion> freeze_region(const Surface& rest, Interval u, Interval v,
                                     ConstraintList& to);

/// How a curve is kept.
struct CurveHold {
  int constraints = 0;  ///< how many were appended
  /// No point of the curve moves by more than this times the largest displacement of the control
  /// points near it.
  double bound = 0;
};

/// Keeps a curve of the surface, given as a polyline of parameter points (u, v), one per row, at
/// least two.
///
/// Each segment is cut at the knot lines it crosses. On every piece B is a polynomial of degree p +
/// q along the segment, determined by its values at p + q + 1 Chebyshev points; of all these
/// conditions Σ R X = 0, the best independent ones are taken (QR with column pivoting) until each
/// of the others is a combination of them up to a remainder r with Λ |r|_1 <= tolerance, where Λ
/// bounds the growth between the points: 1 + 2/π ln(p + q + 1), times the largest ratio of W on a
/// piece, which is sampled. Hence `bound`. A larger tolerance leaves more freedom near the curve.
/// Pieces are kept on the side of a tear on which they run, vertices on all sides. \param tolerance
/// above 0, up to 1; values below 1e-9 count as 1e-9, rounding apart. Cost: O(r² c) for r points
/// and c control points near the curve, dense, and as much again in memory: meant for curves that
/// cross up to a hundred spans.
Expected<CurveHold> keep_curve(const Surface& rest, const Parameters<2>& polyline, double tolerance,
                               ConstraintList& to, const std::string& name = "curve");

/// A polyline for a curve (x, y) = (u, v)(t) in the parameter domain (z is ignored): the same
/// number of chords per span, doubled until the surface over the middle of each chord is within
/// `tolerance` (file units) of the curve's. Errors: more than 4096 chords per span would be needed
/// (numerical).
[[nodiscard]] Expected<Parameters<2>> parameter_polyline(const Surface& rest,
                                                         const Curve& parameter_curve,
                                                         double tolerance);

/// Tolerances of `keep_smooth`.
struct SmoothOptions {
  double angle = 1e-3;      ///< radian: rest normals that differ by more are a crease
  double gap = 1e-7;        ///< of the diagonal of the control points: sides further apart are torn
  double tolerance = 1e-8;  ///< where the condition is sampled: its remainder, as in `keep_curve`
};

/// A knot line across which the basis alone does not keep the deformed surface smooth.
struct SmoothLine {
  enum class State {
    coupled,    ///< D has the continuity of the rest shape, exactly
    sampled,    ///< the same up to `SmoothOptions::tolerance`: ratio of derivatives or of weights
                ///< varies along the line
    crease,     ///< the rest shape has a crease here; the line may bend freely (but not tear)
    torn,       ///< the two sides of the rest shape lie apart; left free
    linear,     ///< degree 1 across the line: only a crease can bend it; left free (but not torn)
    pointlike,  ///< the rest shape has no normals along the line; left free
  };
  int direction = 0;  ///< 0: the line u = knot
  double knot = 0;
  int multiplicity = 0;
  State state = State::crease;
  double angle = 0;  ///< largest angle between the normals of both sides at rest
  double ratio = 1;  ///< λ of S_u right = λ S_u left
  int constraints = 0;
};

/// No hinges: where the rest shape is tangent-continuous across an interior knot line of
/// multiplicity p or p + 1, the displacement is coupled so that the deformed surface is always
/// tangent-continuous too.
///
/// With ± the two sides of u = c, and S_u⁺ = λ S_u⁻ at rest, the condition is D_u⁺ = λ D_u⁻: then
/// (S + D)_u⁺ = λ (S + D)_u⁻. As D_u = (B_u − W_u D)/W, and W_u⁺ − λ W_u⁻ = κ W with one κ where
/// the weights of the rows near the line are proportional (every CAD quadric), it is
///   Σ_i (N_i'⁺ − λ N_i'⁻ − κ N_i) w_ij X_ij = 0   for every j,
/// for equal knots and weights the relation of three collinear points. At multiplicity p + 1 also
/// X⁺_j = X⁻_j (C0), and the right side's weights are divided by their ratio σ to the left's. λ is
/// fitted to S_u at samples, κ and σ to the weights; they count as fixed where the remainder is
/// below `angle` (ratios) or 1e-7 (weights). Otherwise, and where S_u⁺ = λ S_u⁻ + μ S_v, D_u⁺ = λ
/// D_u⁻ + μ D_v is asked at 2q + 4 points per span of the line, as many as are independent to
/// `tolerance`: that can leave a line little freedom, but no hinge. Returns all such lines with
/// their outcome, u first, by knot.
Expected<std::vector<SmoothLine>> keep_smooth(const Surface& rest, const SmoothOptions& options,
                                              ConstraintList& to);

/// An edge that collapses to one point, and the freedom of the first ring of control points around
/// it.
struct Pole {
  SurfaceEdge edge = SurfaceEdge::u0;
  /// Of the vectors from the pole to the ring: 2 a tangent plane, 3 a cone, 1 a needle.
  int rank = 2;
};

/// Poles: edges whose control points coincide to `tolerance` (file units) and whose end is clamped.
/// The pole remains one point, X_0j = X_00, and the first ring moves as an affine image of itself:
/// with V_j = P_1j − P_0 = Σ_k a_jk V_{j_k} over `rank` independent ring points j_k, X_1j − X_0 =
/// Σ_k a_jk (X_{1 j_k} − X_0).
///
/// At the pole S_u ~ Σ_j M_j w_1j V_j, so D_u = A S_u with one linear map A, whatever the weights:
/// a tangent plane is preserved. The rank counts singular values above `flatness` of the largest;
/// ring vectors lie outside the span by less than that.
Expected<std::vector<Pole>> keep_poles(const Surface& rest, double tolerance, double flatness,
                                       ConstraintList& to);

/// A mirror plane. The normal may have any non-zero length.
struct MirrorPlane {
  Point point = Point::Zero();
  Point normal = Point::UnitX();

  friend bool operator==(const MirrorPlane&, const MirrorPlane&) = default;
};

/// Half a symmetric model: the edge stays in the plane, and with `order` 1 the surface stays
/// perpendicular to it, so that its mirror image joins with a common tangent plane.
///
/// n · D = 0 along the edge, and t · D_u = 0 for both tangents t of the plane: n · Σ_i N_i w_ij
/// X_ij = 0 and t · Σ_i (N_i' − κ N_i) w_ij X_ij = 0 for every j, W_u = κ W along the edge. Errors
/// (input): control points of the edge further than `tolerance` (file units) from the plane; with
/// `order` 1 a cross derivative that deviates from the normal by more than `angle` (radian), or
/// weights of the rows at the edge not proportional to 1e-7: each with the amount.
Expected<void> hold_symmetry_plane(const Surface& rest, SurfaceEdge edge, const MirrorPlane& plane,
                                   int order, double tolerance, double angle, ConstraintList& to);

/// How far a surface is from S(a + b − u, v) = mirror image of S(u, v) (direction 0 on the domain
/// [a, b]; 1 likewise).
struct MirrorReport {
  /// Largest distance between a point and the image of its partner at samples, file units.
  double shape = 0;
  double knots = 0;  ///< largest distance of an interior knot's image from the nearest knot, of the
                     ///< domain's length
  /// Largest relative difference of partners; 0 where the knots have no partners.
  double weights = 0;
  bool clamp = false;  ///< the knots outside the domain have no partners: both ends must be clamped
  std::vector<double> insert;  ///< knots whose insertion makes the knots symmetric, ascending,
                               ///< repeated as often as needed
};

/// \param tolerance relative, for knots and weights.
[[nodiscard]] Expected<MirrorReport> mirror_report(const Surface& rest, int direction,
                                                   const MirrorPlane& plane, double tolerance);

/// The plane that best mirrors S(u, v) to S(a + b − u, v): its normal is the principal direction of
/// the vectors between partners at samples, its point the mean of their midpoints. Errors
/// (numerical): all partners coincide.
[[nodiscard]] Expected<MirrorPlane> mirror_plane(const Surface& rest, int direction);

/// Keeps the displacement mirror symmetric, n · (X_a + X_b) = 0 and t · (X_a − X_b) = 0 for
/// partners a and b of the net. The rest shape itself need not be symmetric; the report says by how
/// much. Errors (input): knots or weights not symmetric to `tolerance` (relative), with the amount
/// and the knots to insert.
Expected<MirrorReport> keep_mirror(const Surface& rest, int direction, const MirrorPlane& plane,
                                   double tolerance, ConstraintList& to);

}  // namespace knead
