#pragma once

#include <span>
#include <vector>

#include "visible_search.hpp"

namespace knead::morph {

/// A point of the data without a partner.
struct LeftOutPoint {
  std::size_t number = 0;  ///< its position in the data
  Point place = Point::Zero();
  double distance = 0;  ///< from the nearest visible point; infinite: farther than was sought
};

/// Which points of a model the data are about.
struct Correspondences {
  static constexpr std::size_t most_listed = 20;

  std::vector<Datum> data;                        ///< in the order of the points
  std::vector<std::size_t> numbers;               ///< of each, the position of its point
  std::size_t left_out = 0;                       ///< points farther from every face than the reach
  std::vector<LeftOutPoint> listed;               ///< the first of them
  double largest_distance = 0, rms_distance = 0;  ///< of the others, from the model
};

/// The unit normal of a surface; 0 where it has none. Errors: those of evaluation.
[[nodiscard]] Expected<Point> normal_at(const Surface& surface,
                                        const std::array<double, 2>& parameters);

/// (d · n) n of a displacement d, n the unit normal of the surface there; 0 where it has none.
/// Errors: those of evaluation.
[[nodiscard]] Expected<Point> part_along_normal(const Point& displacement, const Surface& surface,
                                                const std::array<double, 2>& parameters);

struct CorrespondenceSettings {
  double reach = 0;           ///< farthest that a point may be from a face, > 0
  bool along_normal = false;  ///< only `part_along_normal` of displacements
};

/// The partner of every point, its nearest visible point, with the displacement given there.
/// Requires: one displacement for each point (asserted). Results do not depend on the number of
/// threads. Where a surface has no normal nothing is left of a displacement along it. Errors: those
/// of evaluation. Cost: that of `VisibleSearch`, shared among threads.
[[nodiscard]] Expected<Correspondences> correspond(const VisibleSearch& search,
                                                   std::span<const FitSurface> surfaces,
                                                   std::span<const Point> points,
                                                   std::span<const Point> displacements,
                                                   const CorrespondenceSettings& settings);

}  // namespace knead::morph
