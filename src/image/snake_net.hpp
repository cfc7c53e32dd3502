#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "knead/image/snake.hpp"
#include "knead/solve/sparse_cholesky.hpp"
#include "knead/spline/basis.hpp"

namespace knead {

/// The space of a snake with its matrix. A closed one has periodic knots, and its unknowns are the
/// control points that differ: function i belongs to unknown i mod N.
///
/// An iteration solves (γ M + α G11 + β G22 + springs) c⁺ = ∫ N (γ v + f) ds for both coordinates
/// at once, of a banded matrix (with corners where the snake is closed) that changes with γ alone:
/// factored once, O(N p²), each iteration then costs O(N p) and the image at the Gauss points.
class SnakeNet {
 public:
  /// On spans between these places of the parameter, ascending, at least p + 1 of them for a closed
  /// snake. `projection`: with M alone, for least squares, and the first and the last unknown of an
  /// open one held. Errors: those of the factorisation.
  [[nodiscard]] static Expected<SnakeNet> create(std::span<const double> breaks,
                                                 const SnakeSettings& settings,
                                                 bool projection = false);

  /// Factors for another viscosity than that of the settings. Errors: those of the factorisation.
  [[nodiscard]] Expected<void> set_viscosity(double gamma);

  [[nodiscard]] const KnotVector& knots() const { return knots_; }
  [[nodiscard]] const std::vector<double>& breaks() const { return breaks_; }
  [[nodiscard]] int unknowns() const { return unknowns_; }
  [[nodiscard]] const BasisQuadrature& quadrature() const { return quadrature_; }
  [[nodiscard]] int points_per_span() const {
    return quadrature_.basis.size() / static_cast<int>(breaks_.size() - 1);
  }

  /// The places (derivative 0) or tangents (1) at the Gauss points.
  [[nodiscard]] Points at_gauss(const Points& c, int derivative) const;
  /// The c⁺ of (A + springs) c⁺ = ∫ N f ds + springs + forces on the ends, f one row per Gauss
  /// point; held unknowns as in `c`.
  [[nodiscard]] Points solve(const Points& f, const Points& c,
                             const std::array<Eigen::RowVector3d, 2>& ends = {
                                 Eigen::RowVector3d::Zero(), Eigen::RowVector3d::Zero()}) const;
  /// The contour with all its control points.
  [[nodiscard]] Expected<Curve> curve(const Points& c) const;
  /// The unknowns of a curve on these knots.
  [[nodiscard]] Points unknowns_of(const Curve& curve) const {
    return curve.control_points().topRows(unknowns_);
  }

 private:
  SnakeNet(KnotVector knots, std::vector<double> breaks)
      : knots_(std::move(knots)), breaks_(std::move(breaks)) {}
  [[nodiscard]] int unknown(int function) const { return function % unknowns_; }

  KnotVector knots_;
  std::vector<double> breaks_;
  int unknowns_ = 0;
  bool held_ = false;
  BasisQuadrature quadrature_ = {};
  SparseMatrix mass_ = {}, stiffness_ = {};  ///< springs are stiff
  SparseMatrix matrix_ = {};                 ///< before the ends are held
  Points springs_ = {};                      ///< what springs add to the right side
  std::optional<SparseCholesky> factor_ = {};
};

/// The places where the spans of a curve meet, its domain's ends included.
[[nodiscard]] std::vector<double> breaks_of(const Curve& curve);

/// A curve in a net that contains it, by projection: exact up to rounding.
[[nodiscard]] Expected<Points> projected(const Curve& curve, std::span<const double> breaks,
                                         const SnakeSettings& settings);

/// The unknowns of the contour near places in their order, by least squares over the chord length.
/// Errors (input): a place that is not finite, the same place throughout.
[[nodiscard]] Expected<Points> fitted(std::vector<std::array<double, 2>> places,
                                      std::span<const double> breaks,
                                      const SnakeSettings& settings);

/// The length of the polygon through places.
[[nodiscard]] double chord_length(std::span<const std::array<double, 2>> places, bool closed);

}  // namespace knead
