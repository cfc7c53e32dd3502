#pragma once

#include <array>
#include <span>

#include "knead/spline/evaluate.hpp"

namespace knead {

/// Unit normals of a surface from its first derivatives,
///   n = S_u × S_v / |S_u × S_v|      (do Carmo, Differential Geometry of Curves and Surfaces, 2.4; The NURBS
///   Book, 3.5),
/// one per row of an evaluation of order 1 at least; those of rational surfaces too, whose derivatives these are.
///
/// Where the derivatives span no plane the normal is (0, 0, 0), never a neighbour's or a limit's: where
///   |S_u × S_v| <= 1e-9 (|S_u|² + |S_v|²),
/// as at poles, where an edge is one point; at cusps; and where S_u and S_v are parallel. This depends on the units of
/// the parameters: directions whose speeds differ by more than 1e9 have no normals. Accuracy elsewhere: 4 ulp of 1
/// times |S_u| |S_v| / |S_u × S_v| beside what the derivatives err by. Speeds from 1e-75 to 1e75. Requires: order >= 1
/// (asserted). Memory that `result` holds is used again. Uses several threads where it pays.
void unit_normals(const Evaluation<2>& evaluation, Points& result);
[[nodiscard]] Points unit_normals(const Evaluation<2>& evaluation);

/// The same of a surface at scattered parameter points. At a knot the derivatives are limits from `side`.
/// Errors: as of `evaluate`. `Evaluator` keeps the basis where the net changes from call to call.
[[nodiscard]] Expected<Points> unit_normals(const Surface& surface, const Parameters<2>& parameters,
                                            Side side = Side::right);

/// And on a grid, last direction fastest, bit for bit as at scattered points. Errors: as of `evaluate_grid`.
[[nodiscard]] Expected<Points> unit_normals_on_grid(const Surface& surface,
                                                    const std::array<std::span<const double>, 2>& parameters,
                                                    Side side = Side::right);

}  // namespace knead
