#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "knead/hold/surface_edge.hpp"
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
/// The map from the parameters of `a` to those of `b` is affine, from the ends of one domain to the ends of the other:
/// with t = (x − lower)/length on either side, t_b = t_a, or 1 − t_a where `reversed`. A patch closed in u has a seam
/// between its u0 and u1; an edge folded onto itself is a seam with a = b, reversed.
struct Seam {
  PatchEdge a, b;
  bool reversed = false;
  SeamKind kind = SeamKind::whole;
  /// Largest distance at the samples, file units: between corresponding points (`whole`), of either curve from the
  /// other (`reparametrised`), or over the common part (`partial`).
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
/// Every edge is sampled p + 3 times per span (at least 24 times), knots included. Two edges are a `whole` seam if all
/// samples of either lie within the tolerance of the point of the other at the mapped parameter; of the two
/// orientations the closer is taken. Otherwise samples are compared with the nearest point of the other curve: all of
/// both within the tolerance is `reparametrised`; a tenth or more of one of the edges is `partial`. Opposite edges of
/// one patch are compared only where the patch departs from them by more than the tolerance, so that a strip thinner
/// than the tolerance is not joined to itself. \param tolerance a length in file units, > 0;
/// `suggested_seam_tolerance` where nothing better is known. Accuracy: `gap` is the maximum over the samples. Cost: O(E
/// s) evaluations and a sweep over the boxes of E = 4 N edges; pairs whose boxes overlap cost O(s), O(s²) where ends do
/// not meet. Errors: the tolerance is not a positive number (input).
[[nodiscard]] Expected<FoundSeams> find_seams(std::span<const Surface* const> patches, double tolerance);

/// The gap of a seam of `before` in the same patches as they are `now`, on whatever basis: the largest distance between
/// points that were together, at the samples of `find_seams`. Of part of an edge those within the gap of the seam
/// count. Errors: those of evaluation.
[[nodiscard]] Expected<double> moved_gap(const Seam& seam, std::span<const Surface* const> before,
                                         std::span<const Surface* const> now);

/// 1 or −1 for each of so many patches: times these, the normals S_u × S_v of all patches that seams connect with
/// `first` lie on the side of its own, whatever the angle between them. 1 for the others.
/// Seams that are `reparametrised` count for nothing; where some contradict each other (a Möbius strip), the first one
/// decides.
[[nodiscard]] std::vector<double> seam_sides(std::span<const Seam> seams, int patches, int first);

/// 1e-4 of the diagonal of the box of all control points: CAD systems leave gaps of 1e-6 to 1e-4 of the model, and
/// edges shorter than that are details too fine to sculpt. A larger gap needs a larger tolerance.
[[nodiscard]] double suggested_seam_tolerance(std::span<const Surface* const> patches);

}  // namespace knead
