#pragma once

#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/knot_vector.hpp"

namespace knead::detail {

/// An interval on which the functions of two knot vectors are polynomials, with the spans of both
/// that contain it.
struct Piece {
  double lower, upper;
  int first_span, second_span;
};

/// The pieces of positive length into which the knots of both cut their common domain, ascending.
/// Errors: domains that differ in any bit, as no function of one could then represent one of the
/// other.
[[nodiscard]] Expected<std::vector<Piece>> common_pieces(const KnotVector& first,
                                                         const KnotVector& second);

}  // namespace knead::detail
