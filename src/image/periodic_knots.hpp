#pragma once

#include <span>
#include <vector>

#include "knead/spline/knot_vector.hpp"

namespace knead {

/// The knots of functions that come around again where the last of these ascending breaks is the
/// first: the spans go on beyond both ends, `degree` of them, by whole turns. Errors (input): fewer
/// spans than the degree; those of `KnotVector::create`.
inline Expected<KnotVector> periodic_knots(int degree, std::span<const double> breaks) {
  const int spans = static_cast<int>(breaks.size()) - 1;
  if (spans < degree) return input_error("too few spans to come around", "knots");
  const double length = breaks.back() - breaks.front();
  std::vector<double> knots;
  for (int k = -degree; k <= spans + degree; ++k) {
    const int turns = k < 0 ? -1 : k > spans ? 1 : 0;
    knots.push_back(breaks[static_cast<std::size_t>(k - turns * spans)] + turns * length);
  }
  return KnotVector::create(degree, std::move(knots));
}

}  // namespace knead
