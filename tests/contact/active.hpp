#pragma once

#include <gtest/gtest.h>

#include "knead/contact/active_spline.hpp"
#include "support/surfaces.hpp"
#include "support/tools.hpp"

namespace knead::testing {

inline std::vector<bool> rim(const Surface& s, int rows) {
  const auto [m, n] = s.net();
  std::vector<bool> held;
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j)
      held.push_back(i < rows || j < rows || i >= m - rows || j >= n - rows);
  }
  return held;
}

template <int D>
Spline<D> box(int degree, int net) {
  std::vector<KnotVector> knots(D, *KnotVector::clamped_uniform(degree, net));
  int size = 1;
  for (int d = 0; d < D; ++d) size *= net;
  Points points = Points::Zero(size, 3);
  for (int i = 0; i < size; ++i) {
    for (int d = D, rest = i; d-- > 0; rest /= net) points(i, d) = knots[0].greville(rest % net);
  }
  if constexpr (D == 1) return *Curve::create({knots[0]}, points);
  if constexpr (D == 2) return *Surface::create({knots[0], knots[1]}, points);
  if constexpr (D == 3) return *Volume::create({knots[0], knots[1], knots[2]}, points);
}

/// Both ends of the first direction.
template <int D>
std::vector<bool> ends(const Spline<D>& s, int rows) {
  std::vector<bool> held(static_cast<std::size_t>(s.size()));
  const int slab = s.size() / s.net()[0];
  for (int i = 0; i < s.size(); ++i) {
    const int row = i / slab;
    held[static_cast<std::size_t>(i)] = row < rows || row >= s.net()[0] - rows;
  }
  return held;
}

template <int D>
ActiveSpline<D> active(const Spline<D>& s, const ActiveSettings<D>& settings) {
  auto made = ActiveSpline<D>::create(s, settings);
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

/// A sheet over the unit square with two rows held, for the ball above it.
inline ActiveSettings<2> sheet_settings(const Surface& s,
                                        StepAccuracy accuracy = StepAccuracy::exact) {
  ActiveSettings<2> settings;
  settings.held = rim(s, 2);
  settings.detail = 0.15;
  settings.lambda = 20;
  settings.accuracy = accuracy;
  return settings;
}

inline Tool ball_above_sheet(double stiffness) {
  return {"ball", sphere_at(Point(0.5, 0.5, 0.16), 0.15), ToolMode::collision, stiffness, 1};
}

}  // namespace knead::testing
