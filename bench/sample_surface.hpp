#pragma once

#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead::bench {

/// A bicubic net of 32 × 32 control points, the same knots in both directions.
inline Surface sample_surface(bool rational) {
  constexpr int net = 32;
  const auto knots = KnotVector::clamped_uniform(3, net);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> offset(-0.3, 0.3), weight(0.5, 2);
  Points points(net * net, 3);
  std::vector<double> weights;
  for (int i = 0; i < net; ++i) {
    for (int j = 0; j < net; ++j) {
      points.row(i * net + j) << i + offset(random), j + offset(random),
          std::sin(0.3 * i) * std::cos(0.25 * j);
      if (rational) weights.push_back(weight(random));
    }
  }
  auto surface = Surface::create({*knots, *knots}, points, weights);
  if (!surface) std::abort();
  return *surface;
}

/// As many in either direction.
inline constexpr int sample_grid = 500;
inline std::vector<double> sample_parameters() {
  std::vector<double> result;
  for (int k = 0; k < sample_grid; ++k) result.push_back(k / static_cast<double>(sample_grid - 1));
  return result;
}

}  // namespace knead::bench
