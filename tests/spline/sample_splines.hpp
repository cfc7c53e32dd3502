#pragma once

#include <gtest/gtest.h>

#include <random>

#include "knead/spline/evaluate.hpp"
#include "support/knot_families.hpp"

namespace knead::testing {

/// Any valid spline, or a failure that says why there is none.
template <int D>
Spline<D> make_spline(std::array<KnotVector, D> knots, Points points,
                      std::vector<double> weights = {}) {
  auto made = Spline<D>::create(std::move(knots), std::move(points), std::move(weights));
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

/// Coordinates in [-1, 1]; weights 10^x with |x| <= decades, none for decades < 0.
template <int D>
Spline<D> random_spline(std::mt19937_64& random, std::array<KnotVector, D> knots,
                        double decades = -1) {
  int size = 1;
  for (const KnotVector& k : knots) size *= k.count();
  std::uniform_real_distribution<double> uniform(-1, 1);
  Points points(size, 3);
  for (int i = 0; i < size; ++i) points.row(i) << uniform(random), uniform(random), uniform(random);
  std::vector<double> weights;
  for (int i = 0; i < size && decades >= 0; ++i)
    weights.push_back(std::pow(10, decades * uniform(random)));
  return make_spline<D>(std::move(knots), std::move(points), std::move(weights));
}

/// Ends and interior knots of the domain and places in every span.
inline std::vector<double> places(const KnotVector& knots) {
  std::vector<double> result;
  for (const int s : knots.spans()) {
    const double a = knots[s], b = knots[s + 1];
    for (const double t : {0.0, 0.3, 0.5, 0.9}) result.push_back(a + t * (b - a));
  }
  result.push_back(knots.domain().upper);
  return result;
}

template <int D>
std::array<std::vector<double>, D> grid_of(const Spline<D>& spline) {
  std::array<std::vector<double>, D> grid;
  for (std::size_t d = 0; d < D; ++d) grid[d] = places(spline.knots()[d]);
  return grid;
}

template <int D>
std::array<std::span<const double>, D> spans_of(const std::array<std::vector<double>, D>& grid) {
  std::array<std::span<const double>, D> result;
  for (std::size_t d = 0; d < D; ++d) result[d] = grid[d];
  return result;
}

/// All combinations, last direction fastest: the rows of `evaluate_grid`.
template <int D>
Parameters<D> rows_of(const std::array<std::vector<double>, D>& grid) {
  Eigen::Index rows = 1;
  for (const auto& g : grid) rows *= static_cast<Eigen::Index>(g.size());
  Parameters<D> result(rows, D);
  for (Eigen::Index row = 0; row < rows; ++row) {
    Eigen::Index rest = row;
    for (int d = D - 1; d >= 0; --d) {
      const auto& g = grid[static_cast<std::size_t>(d)];
      result(row, d) = g[static_cast<std::size_t>(rest % static_cast<Eigen::Index>(g.size()))];
      rest /= static_cast<Eigen::Index>(g.size());
    }
  }
  return result;
}

}  // namespace knead::testing
