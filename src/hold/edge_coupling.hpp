#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "knead/solve/linear_constraint.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

/// A point that two patches or more share: the patches by number, and its parameters on each.
using SharedPoint = std::vector<std::pair<int, std::array<double, 2>>>;

/// A curve in space along which patches stay together.
struct CoupledEdge {
  std::string name;  ///< in messages
  std::vector<SharedPoint> points;
  /// At every point, for each patch in the order there, the direction in its parameters in which
  /// the derivatives of the displacements agree too; none at points where nothing is required of
  /// them. Empty: nowhere.
  std::vector<std::vector<Eigen::Vector2d>> across = {};
};

/// How closely, above 0 and up to 1.
struct CouplingTolerance {
  double position = 0.2;  ///< of the largest displacement of a control point
  /// Of derivatives, of the largest change that moving one control point by 1 makes.
  double tangent = 0.2;

  friend bool operator==(const CouplingTolerance&, const CouplingTolerance&) = default;
};

/// What keeps patches together along a curve.
struct EdgeCoupling {
  std::vector<LinearConstraint> constraints;
  /// At none of the points two patches part by more than this times the largest displacement of a
  /// control point.
  double bound = 0;
};

/// Linear conditions on the displacements X of the control points that keep patches together along
/// curves, which may run through the inside of spans, at different speeds on either side, and meet
/// one another in vertices:
///
///   Σ R_a,ij X_a,ij − Σ R_b,ij X_b,ij = 0
///
/// at the points of the curve, for the first patch there and each other one, and likewise for the
/// derivatives Σ ∂R_ij X_ij in the directions `across`, which keep tangent planes common: with
/// position, the differentials of all displacements then agree on the plane that the patches shared
/// (docs/design/trims.md).
///
/// Two nets have few displacements along a curve exactly in common. Hence conditions are not taken
/// at all points: first everything is expressed by the unknowns that the constraints so far leave
/// independent; then the best independent rows are chosen (QR with column pivoting), until each of
/// the others is a combination of them up to a remainder r with |r|_1 <= tolerance; derivatives
/// after positions, in units of the largest coefficient of the curve. A larger tolerance leaves
/// more freedom: displacements that both nets can represent to it. Equal nets lose nothing, and
/// conditions that follow from seams or meet in a vertex are not repeated, whatever their rounding.
/// Curves are taken one after another, each given those before it.
///
/// \param rows first unknown of every patch, and the end
/// \param before constraints that hold anyway
/// \param held one flag per unknown, or empty
/// Errors: a parameter outside the domain, a tolerance out of range (input); a denominator that is
/// not positive (numerical); those of the constraints so far. Cost: one elimination of the
/// constraints before, and per curve O(m n min(m, n)) for m points and n unknowns near it.
[[nodiscard]] Expected<EdgeCoupling> couple_edges(std::span<const Surface* const> patches,
                                                  std::span<const int> rows,
                                                  std::span<const CoupledEdge> edges,
                                                  std::span<const LinearConstraint> before,
                                                  const std::vector<bool>& held,
                                                  const CouplingTolerance& tolerance);

}  // namespace knead
