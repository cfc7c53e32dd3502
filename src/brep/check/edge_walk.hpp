#pragma once

#include <array>
#include <optional>
#include <vector>

#include "checked_face.hpp"

namespace knead::brep {

/// A face at an edge, as one of the uses of the edge has it.
struct EdgeSide {
  const CheckedFace* face = nullptr;
  /// 1: the face is to the left of the edge's curve, seen from the tip of the normal of its
  /// surface; -1: to the right.
  int way = 1;
  std::optional<CheckedFace::Side> line = {};  ///< of a seam
};

/// What is measured, each by its largest value.
enum class Measure { gap, off_curve, angle, curvature, relative_curvature };
inline constexpr std::size_t measure_count = 5;

/// A point of an edge.
struct EdgeSample {
  double t = 0;  ///< of the curve
  Point point = Point::Zero();
  std::vector<FaceFoot> feet;                     ///< one for each side
  std::array<double, measure_count> values = {};  ///< angles in radians; none: -1
  [[nodiscard]] double operator[](Measure m) const { return values[static_cast<std::size_t>(m)]; }
};

/// Lengths and angles below which nothing is refined, and curvatures that count.
struct EdgeScale {
  double size = 1;     ///< of the model
  double tangent = 0;  ///< radians: up to here curvatures are compared
  [[nodiscard]] double flat() const { return 1e-3 / size; }
  [[nodiscard]] std::array<double, measure_count> negligible() const {
    return {1e-9 * size, 1e-9 * size, 1.7e-8, 1e-3 * flat(), 1e-3};
  }
};

/// An edge walked along, with everything that was looked at.
struct EdgeWalk {
  std::vector<EdgeSample> samples;                ///< by ascending parameter
  std::array<EdgeSample, measure_count> largest;  ///< where each measure is largest
  double length = 0;
};

/// Samples an edge as `measure_edges` says.
[[nodiscard]] EdgeWalk walk(const EdgePiece& piece, const std::vector<EdgeSide>& sides,
                            const EdgeScale& scale);

}  // namespace knead::brep
