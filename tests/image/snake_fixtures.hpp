#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "knead/image/snake.hpp"

namespace knead::testing {

/// A disc with an edge whose grey value is ½ (1 − erf(d / (√2 σ))) at the distance d: steepest
/// exactly at the radius.
inline Image blurred_disc(int size, double x, double y, double radius, double sigma) {
  Image image{size, size, {}};
  for (int j = 0; j < size; ++j) {
    for (int i = 0; i < size; ++i) {
      image.values.push_back(
          (1 - std::erf((std::hypot(i - x, j - y) - radius) / (std::numbers::sqrt2 * sigma))) / 2);
    }
  }
  return image;
}

/// Places along a circle, in their order.
inline std::vector<std::array<double, 2>> circle(double x, double y, double radius,
                                                 int count = 200) {
  std::vector<std::array<double, 2>> points;
  for (int k = 0; k < count; ++k) {
    points.push_back({x + radius * std::cos(2 * std::numbers::pi * k / count),
                      y + radius * std::sin(2 * std::numbers::pi * k / count)});
  }
  return points;
}

}  // namespace knead::testing
