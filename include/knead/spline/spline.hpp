#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "knead/spline/knot_vector.hpp"

namespace knead {

/// N points in space, one per row, coordinates x, y, z.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Point = Eigen::Vector3d;

/// The largest magnitude of a coordinate, a weight or a knot of a spline, and the inverse of the
/// least length of a domain. Distances, curvatures and areas are made of products of up to four
/// lengths and of squares of weights: within this bound, which is far from all lengths that are
/// measured, none of these overflows or vanishes.
inline constexpr double largest_number = 1e50;

/// A tensor-product B-spline or NURBS: D = 1 curve, 2 surface, 3 volume (thesis
/// Eqs. 4.1, 4.4, 4.6, 4.7).
///
/// S(u) = Σ_i R_i(u) P_i with R_i = N_i, or R_i = w_i N_i / Σ w N where there are weights; N_i is
/// the product of one basis function per direction. Control points are Cartesian (never
/// premultiplied by the weight) and stored row by row with the last direction fastest: on a surface
/// with net m × n, control point (i, j) is row i n + j. Every number is kept bit for bit.
/// Immutable.
template <int D>
class Spline {
 public:
  /// Checks: as many control points as the knots require, all finite; weights either none, or one
  /// per control point, finite; no number of them or of the knots above `largest_number`, no domain
  /// shorter than its inverse, and not all weights below it. An `Error` names the index. Negative
  /// and zero weights are accepted: only the denominator Σ w N must be positive on the domain, and
  /// functions that divide by it report where it is not.
  [[nodiscard]] static Expected<Spline> create(std::array<KnotVector, D> knots,
                                               Points control_points,
                                               std::vector<double> weights = {});

  [[nodiscard]] const KnotVector& knots(int direction) const {
    return knots_[static_cast<std::size_t>(direction)];
  }
  [[nodiscard]] const std::array<KnotVector, D>& knots() const { return knots_; }
  /// Number of control points in each direction.
  [[nodiscard]] std::array<int, D> net() const;
  /// Total number of control points.
  [[nodiscard]] int size() const { return static_cast<int>(control_points_.rows()); }
  [[nodiscard]] const Points& control_points() const { return control_points_; }
  /// True if the spline was made with weights, even if all are equal.
  [[nodiscard]] bool rational() const { return !weights_.empty(); }
  /// One weight per control point, in their order; empty for a polynomial spline.
  [[nodiscard]] std::span<const double> weights() const { return weights_; }

  /// The same spline with other control points; checked as in `create`.
  [[nodiscard]] Expected<Spline> with_control_points(Points control_points) const;

 private:
  Spline(std::array<KnotVector, D> knots, Points control_points, std::vector<double> weights)
      : knots_(std::move(knots)),
        control_points_(std::move(control_points)),
        weights_(std::move(weights)) {}

  std::array<KnotVector, D> knots_;
  Points control_points_;
  std::vector<double> weights_;
};

using Curve = Spline<1>;
using Surface = Spline<2>;
using Volume = Spline<3>;

}  // namespace knead
