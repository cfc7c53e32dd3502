#pragma once

#include <optional>
#include <span>
#include <vector>

#include "display.hpp"

namespace knead {

/// Where the colours of a display end, and what there is beyond; all in the unit of the display.
struct DisplayRange {
  double lower = 0, upper = 0;     ///< the ends of the palette
  double least = 0, greatest = 0;  ///< of all visible values
};

/// Finds the range of colours for the values of one display on any number of surfaces.
///
/// The ends are the quantiles `Display::percentiles` of the values over the visible area: each
/// value stands for the part of the surface round its grid point, |S_u × S_v| Δu Δv. Thus a pole,
/// at which many grid points and the largest curvatures lie, counts for the little that is seen of
/// it. Where the palette diverges the ends are symmetric, of the larger magnitude; where it rises
/// the lower one is 0. `Display::share` scales both; `Display::limits` take their place.
///
/// Quantiles are taken over every third grid line in each direction. A point counts as visible if
/// the nearest of those points is, which is exact to two lines of the grid; where none of them is,
/// because the visible part lies between them, all count. Values that are not finite do not count.
class DisplayRangeFinder {
 public:
  /// Adds one surface. Requires: one value for each grid point of the input. Cost: linear in the
  /// grid points; of a trimmed surface, `VisibleRegion::contains` for a ninth of them, once per
  /// grid (kept in `DisplayInput::memory`).
  void add(const DisplayInput& input, std::span<const double> values);
  /// None if nothing visible has been added. Cost: that of sorting a ninth of the values.
  [[nodiscard]] std::optional<DisplayRange> range(const Display& display) const;
  void clear() { *this = {}; }

 private:
  struct Sample {
    double value, area;
  };
  std::vector<Sample> samples_;
  std::optional<std::array<double, 2>> extremes_;  // least, greatest
};

}  // namespace knead
