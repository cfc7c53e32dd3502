#pragma once

#include <functional>
#include <optional>

#include "fit_joints.hpp"
#include "fit_matrix.hpp"
#include "knead/energy/domain_scaling.hpp"

namespace knead::morph {

/// A datum as it is fitted: without the affine part, with a weight that is the share of the area of
/// its surface that it stands for.
struct FitPoint {
  int surface = 0;
  std::array<double, 2> at = {};
  Point place = Point::Zero();   ///< before the displacement
  Point wanted = Point::Zero();  ///< displacement
  double weight = 0;
  double share = 1;             ///< of that weight, from 1 on: more where residuals are too large
  Point along = Point::Zero();  ///< as of `Datum`
  bool faded = false;  ///< towards what stays: the displacement changes faster than the data do
};

/// The units in which a surface is fitted.
struct FitUnits {
  std::array<double, 2> factors = {1, 1};  ///< of parameters, as `DomainScaling::factors`
  double share = 1;  ///< its area, of the square of the size; at least `least_share`
};
inline constexpr double least_share = 1e-6;

/// After so many solves, what is left.
struct FitState {
  Points x;
  int rounds = 0;
  double largest_residual = 0, rms_residual = 0, largest_parting = 0;
  /// How many data a single solve could follow, the trace of the map from data to D at data.
  double freedom = 0;
  double largest_slope = 0;  ///< |∂D_a − ∂D_b| at smooth joints
};

/// The linear system of a fit on given nets (docs/design/morph.md). Immutable.
class FitSystem {
 public:
  /// Errors: those of evaluation. Cost: Σ (p + 1)⁴ per datum and point of a joint.
  [[nodiscard]] static Expected<FitSystem> create(const FitNets& nets,
                                                  std::span<const FitPoint> points,
                                                  std::span<const Joint> joints,
                                                  std::span<const FitUnits> units, double size);

  /// Iterated Tikhonov, X ← X + (M + λK)⁻¹ (b − M X) from X = 0, until `enough` says so of the
  /// state, which it is asked after every solve. `with_freedom`: estimates it. Errors: the matrix
  /// cannot be factored.
  [[nodiscard]] Expected<FitState> solve(double lambda,
                                         const std::function<bool(const FitState&)>& enough,
                                         bool with_freedom = false) const;

  /// D − d of a datum, of which only the part that is known counts.
  [[nodiscard]] Point residual(std::size_t point, const Points& x) const {
    const Point off = value_of(data_[point], x) - wanted_[point];
    const Point& n = along_[point];
    return n.isZero(0) ? off : Point(n.dot(off) * n);
  }
  /// The largest |D_a − D_b|, less what is wanted of it, of a joint, and the point at which it is.
  struct Parting {
    double distance = 0;
    std::size_t point = 0;
  };
  [[nodiscard]] Parting parting(std::size_t joint, const Points& x) const;

 private:
  FitSystem() = default;
  Expected<void> make_data(const FitNets& nets, std::span<const FitPoint> points);
  /// What M has too much where data are known along a direction n alone, (1 − τ) Σ w r rᵀ (I − n
  /// nᵀ)_cd for the blocks (c, d) of coordinates; empty: all are known.
  [[nodiscard]] std::vector<SparseMatrix> across(int unknowns) const;
  Expected<void> make_joints(const FitNets& nets, std::span<const Joint> joints);
  /// What is wanted of D_a − D_b.
  [[nodiscard]] Point wanted_apart(std::size_t joint, std::size_t point) const {
    return wanted_apart_[joint].empty() ? Point(Point::Zero()) : wanted_apart_[joint][point];
  }
  void measure(FitState& state) const;
  [[nodiscard]] double freedom(const SparseCholesky& factor) const;

  std::vector<Terms> data_;
  std::vector<Point> wanted_, along_;
  std::vector<double> weights_;
  std::vector<std::vector<Terms>> apart_, slopes_;  ///< by joint and point
  std::vector<std::vector<Point>> wanted_apart_;    ///< of `apart_`; empty: zeros
  FitMatrix matrix_;
  Points right_;
};

}  // namespace knead::morph
