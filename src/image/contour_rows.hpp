#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace knead {

/// Calls `row(y, from, to)` for the pixels from…to of row y whose centres are inside a closed
/// polygon by the even-odd rule, for all pieces of all rows of the image.
template <typename Row>
void for_rows_inside(std::span<const std::array<double, 2>> polygon, int width, int height,
                     Row&& row) {
  double top = height, bottom = -1;
  for (const auto& p : polygon) {
    top = std::min(top, p[1]);
    bottom = std::max(bottom, p[1]);
  }
  std::vector<double> at;
  const int first = static_cast<int>(std::max(0.0, std::ceil(top)));
  const int last = static_cast<int>(std::min(height - 1.0, std::floor(bottom)));
  for (int y = first; y <= last; ++y) {
    at.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const auto &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      // Half open: a corner on the row belongs to one of its two edges, so that every row is
      // crossed an even number of times.
      if ((a[1] <= y) == (b[1] <= y)) continue;
      at.push_back(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
    }
    std::ranges::sort(at);
    for (std::size_t k = 0; k + 1 < at.size(); k += 2) {
      const double from = std::max(0.0, std::ceil(at[k])),
                   to = std::min(width - 1.0, std::floor(at[k + 1]));
      if (from <= to) row(y, static_cast<int>(from), static_cast<int>(to));
    }
  }
}

}  // namespace knead
