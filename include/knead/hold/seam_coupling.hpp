#pragma once

#include <span>
#include <string>
#include <vector>

#include "knead/hold/seams.hpp"
#include "knead/solve/linear_constraint.hpp"

namespace knead {

/// The continuity of the displacement across a seam.
enum class SeamContinuity {
  none,      ///< not coupled
  c0,        ///< both sides move together: the gap of the rest shape is kept
  g1,        ///< tangent planes rotate together too: the angle is kept
  periodic,  ///< all derivatives up to p − 1 stay equal too: an unclamped closed direction
};

struct SeamOptions {
  SeamContinuity most = SeamContinuity::periodic;  ///< no seam gets more than this
  /// How far, in radians, the cross-derivatives at rest may be off a fixed ratio for G1 (`SeamReport::deviation`).
  double angle = 0.01;
  /// Knots this close together (in lengths of the domain) are the same, and weights this close (relative) proportional.
  double agreement = 1e-9;
  /// Edges whose only common displacements are constants (different parametrisations or weights): move each as a whole;
  /// otherwise they are left uncoupled.
  bool rigid = true;
};

struct SeamReport {
  Seam seam;
  SeamContinuity continuity = SeamContinuity::none;
  std::string reason;       ///< why not more; empty if nothing is missing
  bool rigid = false;       ///< the edge moves as a whole
  bool restricted = false;  ///< the knots differ: only what both edges can represent is left (`seam_refinements`)
  double mismatch = 0;      ///< largest difference of knots or weights that was treated as rounding
  double angle = 0;         ///< largest angle between the tangent planes at rest, radians; 0: tangent-continuous
  double ratio = 0;         ///< ρ: inward derivatives at rest best obey S_a' = −ρ S_b'
  double deviation =
      0;  ///< max |S_a' + ρ S_b'| / |S_a'|: with G1, the angle changes by at most about this times the rotation
  int constraints = 0;  ///< how many were added
};

struct SeamCoupling {
  std::vector<LinearConstraint> constraints;
  std::vector<SeamReport> reports;  ///< one per seam
};

/// Linear constraints on the displacements X of the control points that keep seams together.
///
/// C0: D_a(t) = D_b(t) along the seam. With edge coefficients E_j = Σ_i N_i(end) w_ij X_ij and weights e_j likewise,
/// both sides are written on the common refinement of their edge spaces (degree raised, knots united), and
///   (R_a E_a)_k / (R_a e_a)_k = (R_b E_b)_k / (R_b e_b)_k     for all k,
/// which is exact where the edge weights are proportional. Equal knots make R the identity: X_a,j = X_b,j. Where one
/// side's knots contain the other's, the finer edge becomes the image of the coarser; otherwise both are confined to
/// the splines common to both nets, a smaller space (`restricted`).
///
/// G1: with ' the derivative into the patch across the edge, D_a' + ρ D_b' = 0, where the rest shape obeys the same
/// with one ρ up to `angle`: a seam that is tangent-continuous at rest remains so. With weights, A = D W gives
///   A_a'/W_a + ρ A_b'/W_b = κ D,   κ = (W_a' + (W_a/W_b) ρ W_b') / W_a,
/// which is linear on the common refinement where κ is constant (edge and next rows with proportional weights, or
/// symmetric ones as on a circle). Sharp edges, ratios that vary and other weights get C0.
/// Ratios that differ only by rounding in the file are made equal; otherwise they would lock a corner of four patches.
///
/// Periodic: a patch closed in an unclamped direction whose knots repeat (x_{n−p+k} = x_k + period for 0 < k < 2p) and
/// whose weights repeat up to a factor: X_{n−p+k} = X_k, 0 <= k < p.
///
/// A translation satisfies every constraint, up to rounding. Constraints are redundant where patches meet in a corner:
/// `ConstraintSpace` skips those that follow from others.
/// \param rows first row of every patch in the unknowns, as `ActiveSpline::rows()`.
/// Errors: a seam names a patch that does not exist (input); an edge that cannot be evaluated (numerical).
[[nodiscard]] Expected<SeamCoupling> couple_seams(std::span<const Surface* const> patches, std::span<const int> rows,
                                                  std::span<const Seam> seams, const SeamOptions& options = {});

/// The refinement of one direction of a patch that makes its edge spaces agree with its neighbours'.
struct SeamRefinement {
  int patch = 0;
  int direction = 0;
  int elevate = 0;             ///< first raise the degree this many times (each time repeating every knot once more)
  std::vector<double> insert;  ///< then insert these knots; repetitions count

  friend bool operator==(const SeamRefinement&, const SeamRefinement&) = default;
};

/// The smallest refinements after which the edges of all `whole` seams agree in degree and knots; empty where they do.
/// They propagate from patch to patch until all neighbours agree. Knots closer than `agreement`
/// lengths of the domain are the same. Requires seams of these patches (asserted).
[[nodiscard]] std::vector<SeamRefinement> seam_refinements(std::span<const Surface* const> patches,
                                                           std::span<const Seam> seams, double agreement = 1e-9);

}  // namespace knead
