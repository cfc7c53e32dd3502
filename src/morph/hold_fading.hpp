#pragma once

#include <span>
#include <vector>

#include "fit_problem.hpp"

namespace knead::morph {

/// Whether an edge is held: it says so itself, or some of its surfaces are fixed, not all.
[[nodiscard]] bool is_held(const FitEdge& edge, const std::vector<bool>& fixed);

/// Whether an edge is held, or a surface keeps something of itself.
[[nodiscard]] bool keeps_something(const FitProblem& problem);

/// Fades out data that contradict held edges, where displacements are zero: d becomes β(t) d, so
/// that what is left can be followed together with the holds by nets of moderate size.
///
/// At a point y of a held edge data contradict the hold by J(y) = max (|d_k| − m − |x_k − y| / 4)⁺,
/// m the tolerance, over the data at up to twice the distance of the nearest: a clamped sheet that
/// turns by up to 14 degrees about its edge is no contradiction, and a step is. The distance from
/// the holds, in widths w(y) = 8 J(y), is t = φ^(−1/2) with φ(x) = ½ ∫ w(y)² |x − y|⁻³ dy over the
/// held edges: beside a long straight edge the distance over the width, 0 on every contradicted
/// edge, and analytic elsewhere, between two edges and beyond their ends too, where the nearest
/// distance has kinks that only very fine nets could follow. β(t) = t³ (10 − 15 t + 6 t²) up to
/// t = 1, which keeps tangent planes at the hold as well. Data for which φ <= 1 are not changed.
///
/// Likewise beside lines and points that surfaces keep of themselves, of a point alone φ = w² |x −
/// y|⁻², and beside the cells of knots of which all control points are held. Within these d = 0.
///
/// Appends to `contradicted` the worst datum of each surface whose data have changed by more than
/// the tolerance. Errors: those of evaluation. Cost: held segments times data.
[[nodiscard]] Expected<void> fade_at_holds(FitProblem& problem);

}  // namespace knead::morph
