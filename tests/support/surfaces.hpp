#pragma once

#include <cmath>
#include <random>

#include "knead/spline/evaluate.hpp"
#include "support/knot_families.hpp"

/// Surfaces for the tests of everything that works on one.
namespace knead::testing {

inline Surface make_surface(KnotVector u, KnotVector v, Points points,
                            std::vector<double> weights = {}) {
  auto made = Surface::create({std::move(u), std::move(v)}, std::move(points), std::move(weights));
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

/// Control points at the Greville abscissae: S(u, v) = (width u', height v', 0) with u', v' from 0
/// to 1.
inline Surface sheet(KnotVector u, KnotVector v, double width = 1, double height = 1) {
  Points points(u.count() * v.count(), 3);
  const Interval du = u.domain(), dv = v.domain();
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j) {
      points.row(i * v.count() + j) << width * (u.greville(i) - du.lower) / du.length(),
          height * (v.greville(j) - dv.lower) / dv.length(), 0;
    }
  }
  return make_surface(std::move(u), std::move(v), std::move(points));
}

inline Surface uniform_sheet(int degree, int m, int n, double width = 1, double height = 1) {
  return sheet(*KnotVector::clamped_uniform(degree, m), *KnotVector::clamped_uniform(degree, n),
               width, height);
}

/// A sheet with a gentle random relief and, if asked for, weights of the given spread.
inline Surface relief(KnotVector u, KnotVector v, unsigned seed, double height = 0.1,
                      double weight_spread = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  const Surface flat = sheet(u, v, 1.3, 0.9);
  Points points = flat.control_points();
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    points(i, 2) += height * value(random);
    points(i, 0) += 0.2 * height * value(random);
  }
  std::vector<double> weights;
  if (weight_spread > 1) {
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      weights.push_back(std::pow(weight_spread, value(random)));
  }
  return make_surface(std::move(u), std::move(v), std::move(points), std::move(weights));
}

/// A full cylinder of radius 1 and the given height as every CAD system writes it: 9 control points
/// around, double knots at the quadrants.
inline Surface cylinder(double height = 2) {
  const double r = std::sqrt(0.5);
  const double xy[9][2] = {{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                           {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
  Points points(18, 3);
  std::vector<double> weights;
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 2; ++j) {
      points.row(2 * i + j) << xy[i][0], xy[i][1], height * j;
      weights.push_back(i % 2 == 0 ? 1 : r);
    }
  }
  return make_surface(clamped_knots(2, {0, 1, 2, 3, 4}, {3, 2, 2, 2, 3}), clamped_knots(1, {0, 1}),
                      points, weights);
}

/// A full unit sphere: meridians in v with poles, where a row of the net collapses to a point.
inline Surface sphere() {
  const double r = std::sqrt(0.5);
  const double xy[9][2] = {{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                           {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
  const double rz[5][2] = {{0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}};
  Points points(45, 3);
  std::vector<double> weights;
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 5; ++j) {
      points.row(5 * i + j) << xy[i][0] * rz[j][0], xy[i][1] * rz[j][0], rz[j][1];
      weights.push_back((i % 2 == 0 ? 1 : r) * (j % 2 == 0 ? 1 : r));
    }
  }
  return make_surface(clamped_knots(2, {0, 1, 2, 3, 4}, {3, 2, 2, 2, 3}),
                      clamped_knots(2, {0, 1, 2}, {3, 2, 3}), points, weights);
}

inline Points random_points(Eigen::Index count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  Points points(count, 3);
  for (Eigen::Index k = 0; k < points.size(); ++k) points.data()[k] = value(random);
  return points;
}

}  // namespace knead::testing
