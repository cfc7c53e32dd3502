#pragma once

#include <cmath>
#include <vector>

#include "exchange/step/write/text.hpp"

namespace knead::testing {

/// Surfaces of several kinds without a file: a wavy sheet, a closed rational tube, a cone with a
/// pole, an unclamped sheet, and one on knots and weights that are no short decimals.
inline std::vector<step::NewSurface> new_surfaces() {
  std::vector<step::NewSurface> result;
  const auto add = [&](const char* name, std::array<KnotVector, 2> knots, Points points,
                       std::vector<double> weights = {}) {
    result.push_back(
        {name, *Surface::create(std::move(knots), std::move(points), std::move(weights))});
  };
  const auto sheet = [](int rows, int columns, double height) {
    Points points(rows * columns, 3);
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j)
        points.row(i * columns + j) << 10 * i, 7 * j, height * std::sin(i + 2.0 * j);
    }
    return points;
  };
  const auto cubic = *KnotVector::clamped_uniform(3, 8),
             quadratic = *KnotVector::clamped_uniform(2, 5, -1, 3);
  add("sheet", {cubic, quadratic}, sheet(8, 5, 2));

  const double w = std::sqrt(0.5);
  const auto circle = *KnotVector::create(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}),
             line = *KnotVector::create(1, {0, 0, 1, 1});
  const double ring[9][3] = {{1, 0, 1},   {1, 1, w},  {0, 1, 1},  {-1, 1, w}, {-1, 0, 1},
                             {-1, -1, w}, {0, -1, 1}, {1, -1, w}, {1, 0, 1}};
  Points tube(18, 3), cone(18, 3);
  std::vector<double> weights;
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 2; ++j) {
      tube.row(2 * i + j) << 20 * ring[i][0], 20 * ring[i][1], 50 * j;
      cone.row(i + 9 * j) << 20 * j * ring[i][0], 20 * j * ring[i][1], 30 - 30 * j;
      weights.push_back(ring[i][2]);
    }
  }
  add("tube", {circle, line}, tube, weights);
  std::vector<double> cone_weights;
  for (int k = 0; k < 18; ++k) cone_weights.push_back(ring[k % 9][2]);
  add("cone", {line, circle}, cone, cone_weights);

  add("open", {*KnotVector::create(3, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}), cubic}, sheet(6, 8, 3));
  add("thirds",
      {*KnotVector::create(2, {0, 0, 0, 0.1 + 0.2, 1.0 / 3, 1e-3 * 999.9999999, 1e9, 1e9, 1e9}),
       quadratic},
      sheet(6, 5, 1.0 / 7), std::vector<double>(30, 1 / 3.0));
  return result;
}

}  // namespace knead::testing
