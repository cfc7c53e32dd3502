#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "knead/hold/constraints.hpp"
#include "knead/solve/linear_constraint.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

struct PatchEdge {
  int patch = 0;
  SurfaceEdge edge = SurfaceEdge::u0;

  friend bool operator==(const PatchEdge&, const PatchEdge&) = default;
};

/// "patch 3, edge u1".
[[nodiscard]] std::string to_string(const PatchEdge& edge);

/// How two edges coincide.
enum class SeamKind {
  whole,           ///< the same points at the same parameters, up to one affine map
  reparametrised,  ///< the same curve as a whole, parametrised differently
  partial,         ///< the curves share only a part (a T-junction)
};

/// Two coincident edges, of two patches or of one.
///
/// The map from the parameters of `a` to those of `b` is affine, from the ends of one domain to the
/// ends of the other: with t = (x − lower)/length on either side, t_b = t_a, or 1 − t_a where
/// `reversed`. A patch closed in u has a seam between its u0 and u1; an edge folded onto itself is
/// a seam with a = b, reversed.
struct Seam {
  PatchEdge a, b;
  bool reversed = false;
  SeamKind kind = SeamKind::whole;
  /// Largest distance at the samples, file units: between corresponding points (`whole`), of either
  /// curve from the other (`reparametrised`), or over the common part (`partial`).
  double gap = 0;

  friend bool operator==(const Seam&, const Seam&) = default;
};

/// An edge that collapses to a point: a pole. Poles are never part of a seam.
struct CollapsedEdge {
  PatchEdge edge;
  double size = 0;  ///< diagonal of its box, file units
};

struct FoundSeams {
  std::vector<Seam> seams;                            ///< by a, then by b; a before b
  std::vector<CollapsedEdge> collapsed;               ///< size <= tolerance
  std::vector<std::pair<PatchEdge, Error>> unusable;  ///< edges that cannot be evaluated, and why
};

/// All pairs of edges of these patches that lie within `tolerance` of each other, and all poles.
///
/// Every edge is sampled p + 3 times per span (at least 24 times), knots included. Two edges are a
/// `whole` seam if all samples of either lie within the tolerance of the point of the other at the
/// mapped parameter; of the two orientations the closer is taken. Otherwise samples are compared
/// with the nearest point of the other curve: all of both within the tolerance is `reparametrised`;
/// a tenth or more of one of the edges is `partial`. Opposite edges of one patch are compared only
/// where the patch departs from them by more than the tolerance, so that a strip thinner than the
/// tolerance is not joined to itself. \param tolerance a length in file units, > 0;
/// `suggested_seam_tolerance` where nothing better is known. Accuracy: `gap` is the maximum over
/// the samples. Cost: O(E s) evaluations and a sweep over the boxes of E = 4 N edges; pairs whose
/// boxes overlap cost O(s), O(s²) where ends do not meet. Errors: the tolerance is not a positive
/// number (input).
[[nodiscard]] Expected<FoundSeams> find_seams(std::span<const Surface* const> patches,
                                              double tolerance);

/// The gap of a seam of `before` in the same patches as they are `now`, on whatever basis: the
/// largest distance between points that were together, at the samples of `find_seams`. Of part of
/// an edge those within the gap of the seam count. Errors: those of evaluation.
[[nodiscard]] Expected<double> moved_gap(const Seam& seam, std::span<const Surface* const> before,
                                         std::span<const Surface* const> now);

/// 1 or −1 for each of so many patches: times these, the normals S_u × S_v of all patches that
/// seams connect with `first` lie on the side of its own, whatever the angle between them. 1 for
/// the others. Seams that are `reparametrised` count for nothing; where some contradict each other
/// (a Möbius strip), the first one decides.
[[nodiscard]] std::vector<double> seam_sides(std::span<const Seam> seams, int patches, int first);

/// 1e-4 of the diagonal of the box of all control points: CAD systems leave gaps of 1e-6 to 1e-4 of
/// the model, and edges shorter than that are details too fine to sculpt. A larger gap needs a
/// larger tolerance.
[[nodiscard]] double suggested_seam_tolerance(std::span<const Surface* const> patches);

/// The continuity of the displacement across a seam.
enum class SeamContinuity {
  none,      ///< not coupled
  c0,        ///< both sides move together: the gap of the rest shape is kept
  g1,        ///< tangent planes rotate together too: the angle is kept
  periodic,  ///< all derivatives up to p − 1 stay equal too: an unclamped closed direction
};

struct SeamOptions {
  SeamContinuity most = SeamContinuity::periodic;  ///< no seam gets more than this
  /// How far, in radians, the cross-derivatives at rest may be off a fixed ratio for G1
  /// (`SeamReport::deviation`).
  double angle = 0.01;
  /// Knots this close together (in lengths of the domain) are the same, and weights this close
  /// (relative) proportional.
  double agreement = 1e-9;
  /// Edges whose only common displacements are constants (different parametrisations or weights):
  /// move each as a whole; otherwise they are left uncoupled.
  bool rigid = true;
};

struct SeamReport {
  Seam seam;
  SeamContinuity continuity = SeamContinuity::none;
  std::string reason;  ///< why not more; empty if nothing is missing
  bool rigid = false;  ///< the edge moves as a whole
  /// The knots differ: only what both edges can represent is left (`seam_refinements`).
  bool restricted = false;
  double mismatch = 0;  ///< largest difference of knots or weights that was treated as rounding
  /// Largest angle between the tangent planes at rest, radians; 0: tangent-continuous.
  double angle = 0;
  double ratio = 0;      ///< ρ: inward derivatives at rest best obey S_a' = −ρ S_b'
  double deviation = 0;  ///< max |S_a' + ρ S_b'| / |S_a'|: with G1, the angle changes by at most
                         ///< about this times the rotation
  int constraints = 0;   ///< how many were added
};

struct SeamCoupling {
  std::vector<LinearConstraint> constraints;
  std::vector<SeamReport> reports;  ///< one per seam
};

/// Linear constraints on the displacements X of the control points that keep seams together.
///
/// C0: D_a(t) = D_b(t) along the seam. With edge coefficients E_j = Σ_i N_i(end) w_ij X_ij and
/// weights e_j likewise, both sides are written on the common refinement of their edge spaces
/// (degree raised, knots united), and
///   (R_a E_a)_k / (R_a e_a)_k = (R_b E_b)_k / (R_b e_b)_k     for all k,
/// which is exact where the edge weights are proportional. Equal knots make R the identity: X_a,j =
/// X_b,j. Where one side's knots contain the other's, the finer edge becomes the image of the
/// coarser; otherwise both are confined to the splines common to both nets, a smaller space
/// (`restricted`).
///
/// G1: with ' the derivative into the patch across the edge, D_a' + ρ D_b' = 0, where the rest
/// shape obeys the same with one ρ up to `angle`: a seam that is tangent-continuous at rest remains
/// so. With weights, A = D W gives
///   A_a'/W_a + ρ A_b'/W_b = κ D,   κ = (W_a' + (W_a/W_b) ρ W_b') / W_a,
/// which is linear on the common refinement where κ is constant (edge and next rows with
/// proportional weights, or symmetric ones as on a circle). Sharp edges, ratios that vary and other
/// weights get C0. Ratios that differ only by rounding in the file are made equal; otherwise they
/// would lock a corner of four patches.
///
/// Periodic: a patch closed in an unclamped direction whose knots repeat (x_{n−p+k} = x_k + period
/// for 0 < k < 2p) and whose weights repeat up to a factor: X_{n−p+k} = X_k, 0 <= k < p.
///
/// A translation satisfies every constraint, up to rounding. Constraints are redundant where
/// patches meet in a corner: `ConstraintSpace` skips those that follow from others. \param rows
/// first row of every patch in the unknowns, as `ActiveSpline::rows()`. Errors: a seam names a
/// patch that does not exist (input); an edge that cannot be evaluated (numerical).
[[nodiscard]] Expected<SeamCoupling> couple_seams(std::span<const Surface* const> patches,
                                                  std::span<const int> rows,
                                                  std::span<const Seam> seams,
                                                  const SeamOptions& options = {});

/// The refinement of one direction of a patch that makes its edge spaces agree with its
/// neighbours'.
struct SeamRefinement {
  int patch = 0;
  int direction = 0;
  /// First raise the degree this many times (each time repeating every knot once more).
  int elevate = 0;
  std::vector<double> insert;  ///< then insert these knots; repetitions count

  friend bool operator==(const SeamRefinement&, const SeamRefinement&) = default;
};

/// The smallest refinements after which the edges of all `whole` seams agree in degree and knots;
/// empty where they do. They propagate from patch to patch until all neighbours agree. Knots closer
/// than `agreement` lengths of the domain are the same. Requires seams of these patches (asserted).
[[nodiscard]] std::vector<SeamRefinement> seam_refinements(std::span<const Surface* const> patches,
                                                           std::span<const Seam> seams,
                                                           double agreement = 1e-9);

}  // namespace knead
