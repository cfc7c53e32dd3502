#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "knead/spline/knot_vector.hpp"

namespace knead::figures {

/// The knots of the thesis' tables: 0 … last with 7 replaced by 6 + 10^-r, every knot times
/// `scale`, clamped.
inline KnotVector thesis_knots(int degree, int r, double scale = 1, int last = 13) {
  std::vector<double> knots(static_cast<std::size_t>(degree), 0.0);
  for (int k = 0; k <= last; ++k) knots.push_back((k == 7 ? 6 + std::pow(10.0, -r) : k) * scale);
  knots.insert(knots.end(), static_cast<std::size_t>(degree), last * scale);
  return *KnotVector::create(degree, std::move(knots));
}

/// The thesis' example U = {0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 6, 6, 6}, cubic.
inline const KnotVector& example_knots() {
  static const KnotVector knots = *KnotVector::create(3, {0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 6, 6, 6});
  return knots;
}

}  // namespace knead::figures
