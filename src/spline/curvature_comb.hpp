#pragma once

#include <array>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead {

/// Curvature along one isoparametric curve of a surface, tooth by tooth.
struct CurvatureComb {
  int direction = 0;         ///< the parameter that runs: 0 u, 1 v
  double at = 0;             ///< the other one
  std::vector<double> runs;  ///< the parameter of each tooth
  Points places;             ///< on the surface, one row per tooth
  /// κN of the curve, 1/length: towards the centre of curvature, zero where the curve is straight
  /// or stands still.
  Points vectors;
};

/// How many combs, and how dense.
struct CurvatureCombOptions {
  std::array<int, 2> curves = {
      7, 7};      ///< curves along which u runs, and v; equally spaced in the other parameter
  int teeth = 6;  ///< pieces of every knot span
};

/// The curvature vectors κN = (C'' − (C''·T) T) / |C'|², T = C'/|C'|, of isoparametric curves C (do
/// Carmo, Differential Geometry of Curves and Surfaces, 1.5).
///
/// Curves lie at equal parameters, both ends of the domain among them where there are two or more.
/// Every knot span of the running parameter is sampled from both of its ends, so that a knot at
/// which curvature jumps has two teeth. Derivatives are those of the spline; accuracy: a few ulp of
/// |C''|/|C'|². Cost: two grid evaluations of order 2 per direction. Errors: negative counts, no
/// pieces (usage); a denominator that is not positive (numerical).
[[nodiscard]] Expected<std::vector<CurvatureComb>> curvature_combs(
    const Surface& surface, const CurvatureCombOptions& options = {});

}  // namespace knead
