#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "knead/sculpt/constraints.hpp"
#include "knead/sculpt/visible_region.hpp"

namespace knead {

/// How one edge of a face is held.
struct HeldEdge {
  std::string id;
  int order = 0;  ///< −1: free; 0: position; 1: tangent planes too; 2: curvatures too
  /// The edge runs along knot lines or ends of the domain only, so that no more is held than its order asks. Elsewhere
  /// all derivatives vanish along it.
  bool along_lines = true;
  int points = 0;  ///< control points that this edge was the first to hold
};

/// What `hold_trims` holds.
struct TrimHold {
  std::vector<HeldEdge> edges;  ///< as in the region
  int free = 0;                 ///< control points that may move
  int visible = 0;              ///< control points that act on anything visible
};

/// Holds the edges of a face where they are, exactly: every control point whose basis function acts on a held edge up
/// to that order is held, and so is every one that acts on nothing visible.
///
/// With D the displacement, D and its first `order` derivatives vanish on an edge if no function that has a non-zero
/// derivative of at most that order there may move. For an edge inside spans these are all functions whose support
/// meets the edge; D is then zero on whole spans round it, so that tangent planes and curvatures stay too. For an edge
/// along a line u = c, function N_i with the line at its first or last knot, of multiplicity m among its own knots, is
/// O(|u − c|^(p + 1 − m)): it may move if p + 1 − m > order. On a clamped end that leaves order + 1 rows held. Where
/// the edge is not on the line but for rounding, an order above 0 holds one row more, since derivatives turn beside it.
///
/// A pole (an end of the domain that is one point) is held like an edge with the largest order of any edge.
/// \param orders one per edge of the region: −1 free, 0, 1, 2.
/// \param tolerance a length: an edge that is no further than this from a knot line counts as running along it; the
///   displacement of the edge is then at most `tolerance` times the slope of D there. With an order above 0, one order
///   more is held where it is not on the line but for rounding.
/// Errors: orders of another number, or out of range (usage).
/// Cost: O(chords of the edges · spans each crosses + spans · corners of the loops).
Expected<TrimHold> hold_trims(const Surface& rest, const VisibleRegion& region, std::span<const int> orders,
                              double tolerance, ConstraintList& to);

/// Knots that let a surface move at a place although its edges are held.
///
/// Directions of degree 1, which can only fold, are raised to degree 3 first. Along both isocurves through `at`, as far
/// as `distance` to either side, spans longer than `distance` / max(8, 2p + 2) are divided evenly, and within 1.5
/// `detail` those longer than `detail` / 3: then functions whose whole support lies within `distance` of the place
/// number at least three by three. Spans are measured in space. Where the net would exceed `cap` control points, spans
/// of twice, four times … the length are aimed at.
struct TrimRefinement {
  std::array<int, 2> elevate = {0, 0};        ///< by which the degrees are raised, by direction
  std::array<std::vector<double>, 2> insert;  ///< knots to insert then, ascending; all empty where nothing is needed
  bool capped = false;                        ///< the net may not grow as far as it should

  [[nodiscard]] bool empty() const {
    return elevate[0] == 0 && elevate[1] == 0 && insert[0].empty() && insert[1].empty();
  }
  /// The same shape on the finer net. Errors: those of `elevate_degree` and `insert_knots`.
  [[nodiscard]] Expected<Surface> apply(const Surface& surface) const;
};

/// \param at       parameters
/// \param distance from the nearest held edge, a length > 0
/// \param detail   smallest length that forces there must resolve; 0: none
[[nodiscard]] Expected<TrimRefinement> trim_refinement(const Surface& surface, const std::array<double, 2>& at,
                                                       double distance, double detail, int cap);

/// How many control points a net may have after refinement for trims: four times as many as `opened` has, at least
/// 2500.
[[nodiscard]] int trim_refinement_cap(const Surface& opened);

}  // namespace knead
