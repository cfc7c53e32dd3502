#pragma once

#include "scan.hpp"
#include "visible_search.hpp"

namespace knead::morph {

/// x → rotation · x + shift, right-handed.
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Point shift = Point::Zero();

  [[nodiscard]] Point at(const Point& x) const { return rotation * x + shift; }
  /// Of its rotation, degrees from 0 to 180.
  [[nodiscard]] double angle() const;
};

/// How a scan has been laid onto a model.
struct Alignment {
  RigidMotion motion = {};
  double rms_before = 0, rms_after = 0;  ///< distances of points of the scan from the model
};

/// The motion that lays a scan onto what a model shows.
///
/// Coarse: 72 starts, the 24 right-handed ways of laying principal axes onto each other, and each
/// turned by 30 and 60° about the longest one, middles on middles; each improved against samples of
/// the model, of whose partners the nearer four fifths count. Fine: the four best, point to plane
/// (Y. Chen and G. Medioni, 1992): the small motion that makes Σ w (n · (x + ω × x + v − q))²
/// least, q the nearest visible points and n the normals there, w Tukey's weights of the distances
/// along n, until the points move no more; points whose partner is on a border beside them do not
/// count. Motions that the model leaves free, as the turning of a cylinder, are not made.
///
/// Accuracy: of points of the model itself, rounding, where the start was right: of parts with a
/// symmetry, or of which the scan shows little, another place may fit as well. Results do not
/// depend on the number of threads. Errors (input): fewer than ten points; (numerical) those of
/// evaluation, nothing is visible. Cost: some seconds.
[[nodiscard]] Expected<Alignment> align(const Scan& scan, const VisibleSearch& search,
                                        std::span<const FitSurface> surfaces,
                                        const std::vector<bool>& shown);

}  // namespace knead::morph
