#pragma once

#include <functional>
#include <map>

#include "fit_system.hpp"

namespace knead::morph {

/// Into how many parts a span is to be divided, and how urgently.
struct SpanRefinement {
  int parts = 1;
  double urgency = 0;  ///< the largest found / wanted
};

/// Which spans of a surface are to be divided.
struct SurfaceRefinement {
  /// By direction: of a span, at its left knot.
  std::array<std::map<int, SpanRefinement>, 2> spans = {};
  double urgency = 0;  ///< of the most urgent one
  double excess = 0;   ///< Σ (found / wanted)² over the data of cells whose residuals ask for it
};
using RefinementPlan = std::vector<SurfaceRefinement>;

/// Orders points by surface and cell of knots; points of a cell keep their order.
void sort_by_cells(const FitNets& nets, std::vector<FitPoint>& points);

/// Divides spans of cells in which residuals are too large, in the direction that leaves them.
///
/// What a least-squares fit of degree p leaves of smooth displacements in a cell is, to first
/// order, the Legendre polynomial of degree p + 1 in the one direction or the other, by the
/// derivative of that order in it. The residuals are projected on both, each times {1, t} of the
/// other direction; a direction is divided if its part is more than what is wanted, into as many
/// parts as the order of convergence p + 1 asks for.
/// \param residual of a point by position, in the order of `sort_by_cells`
/// \param wanted largest residual; `noise`: standard deviation of each coordinate, 0: exact data,
/// else parts that noise alone explains, below three deviations, ask for nothing.
void plan_for_residuals(const FitNets& nets, std::span<const FitPoint> points,
                        const std::function<Point(std::size_t)>& residual, double wanted,
                        double noise, RefinementPlan& plan);

/// Halves the spans in which a joint has a point, in the directions in which it runs, on both
/// sides; beside what stays in both directions, since displacements rise from zero there.
void plan_for_joint(const FitNets& nets, const Joint& joint, std::size_t point, double urgency,
                    RefinementPlan& plan);

/// Inserts the knots, the most urgent surfaces first, as long as all nets together have no more
/// control points than `most`. Of a surface for which that is not enough spans are halved at most,
/// the most urgent ones as far as it goes. Returns how many surfaces have got knots. Spans below a
/// thousandth of the domain are not divided. Knots of a mirrored direction stay symmetric. Errors:
/// those of `insert_knots`.
[[nodiscard]] Expected<int> refine(RefinementPlan plan, int most, std::span<const FitSurface> given,
                                   FitNets& nets);

}  // namespace knead::morph
