#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "knead/brep/visible_region.hpp"
#include "knead/hold/constraints.hpp"

namespace knead {

/// How one edge of a face is held.
struct HeldEdge {
  std::string id;
  int order = 0;  ///< −1: free; 0: position; 1: also tangent planes; 2: also curvatures
  /// The edge runs along knot lines or ends of the domain only, so that no more is held than its
  /// order requires. Otherwise all derivatives vanish along it.
  bool along_lines = true;
  int points = 0;  ///< control points that this edge was the first to hold
};

/// The result of `hold_trims`.
struct TrimHold {
  std::vector<HeldEdge> edges;  ///< as in the region
  int free = 0;                 ///< control points that may move
  int visible = 0;              ///< control points that act on anything visible
};

/// Holds the edges of a face in place, exactly: every control point whose basis function affects a
/// held edge up to that order is held, and so is every one that affects nothing visible.
///
/// With D the displacement, D and its first `order` derivatives vanish on an edge if no function
/// that has a non-zero derivative of at most that order there may move. For an edge inside spans
/// these are all functions whose support meets the edge; D is then zero on whole spans around it,
/// so tangent planes and curvatures are kept too. For an edge along a line u = c, function N_i with
/// the line at its first or last knot, of multiplicity m among its own knots, is O(|u − c|^(p + 1 −
/// m)): it may move if p + 1 − m > order. On a clamped end this holds order + 1 rows. Where the
/// edge is off the line by more than rounding, an order above 0 holds one row more, as derivatives
/// vary beside it.
///
/// A pole (an end of the domain that is a single point) is held like an edge with the largest order
/// of any edge.
/// \param orders one per edge of the region: −1 free, 0, 1, 2.
/// \param tolerance a length: an edge no further than this from a knot line counts as running along
/// it; the displacement of the edge is then at most `tolerance` times the slope of D there. With an
/// order above 0, one more order is held where it lies off the line by more than rounding.
/// Errors: a wrong number of orders, or one out of range (usage). Cost: O(chords of the edges ·
/// spans each crosses + spans · corners of the loops).
Expected<TrimHold> hold_trims(const Surface& rest, const VisibleRegion& region,
                              std::span<const int> orders, double tolerance, ConstraintList& to);

/// Knots to insert so that a surface can move at a place although its edges are held.
///
/// Directions of degree 1, which can only fold, are first elevated to degree 3. Along both
/// isocurves through `at`, up to `distance` to either side, spans longer than `distance` / max(8,
/// 2p + 2) are divided evenly, and within 1.5 `detail` those longer than `detail` / 3: then
/// functions whose whole support lies within `distance` of the place number at least three by
/// three. Spans are measured in space. Where the net would exceed `cap` control points, the target
/// span length is doubled, repeatedly if need be.
struct TrimRefinement {
  std::array<int, 2> elevate = {0, 0};  ///< by which the degrees are raised, by direction
  std::array<std::vector<double>, 2>
      insert;           ///< knots to insert then, ascending; all empty where nothing is needed
  bool capped = false;  ///< the cap kept the net coarser than it should be

  [[nodiscard]] bool empty() const {
    return elevate[0] == 0 && elevate[1] == 0 && insert[0].empty() && insert[1].empty();
  }
  /// The same shape on the finer net. Errors: those of `elevate_degree` and `insert_knots`.
  [[nodiscard]] Expected<Surface> apply(const Surface& surface) const;
};

/// \param at       parameters
/// \param distance from the nearest held edge, a length > 0
/// \param detail   smallest length that forces there must resolve; 0: none
[[nodiscard]] Expected<TrimRefinement> trim_refinement(const Surface& surface,
                                                       const std::array<double, 2>& at,
                                                       double distance, double detail, int cap);

/// The largest number of control points after refinement for trims: four times as many as `opened`
/// has, at least 2500.
[[nodiscard]] int trim_refinement_cap(const Surface& opened);

}  // namespace knead
