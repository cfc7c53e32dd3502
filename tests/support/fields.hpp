#pragma once

#include <gtest/gtest.h>

#include <random>

#include "knead/energy/spline_field.hpp"
#include "support/knot_families.hpp"

namespace knead::testing {

template <int D>
SplineField<D> make_field(std::array<KnotVector, D> knots, std::vector<double> coefficients) {
  auto made = SplineField<D>::create(std::move(knots), std::move(coefficients));
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

/// Coefficients between lower and upper.
template <int D>
SplineField<D> random_field(std::array<KnotVector, D> knots, unsigned seed, double lower = 0,
                            double upper = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> value(lower, upper);
  std::size_t count = 1;
  for (const KnotVector& k : knots) count *= static_cast<std::size_t>(k.count());
  std::vector<double> coefficients(count);
  for (double& c : coefficients) c = value(random);
  return make_field<D>(std::move(knots), std::move(coefficients));
}

}  // namespace knead::testing
