#pragma once

#include <utility>

#include "knead/scene/constraint.hpp"

namespace knead {

/// (u, v) at fractions of the domain. Error (input): a number that is not from 0 to 1, named `where`.
[[nodiscard]] Expected<std::array<double, 2>> parameters_at(const Surface& surface, const Fractions& at,
                                                            const char* where = "at");

/// The intervals of u and v of a rectangle in fractions. Errors (input): a number that is not from 0 to 1, a side that
/// decreases.
[[nodiscard]] Expected<std::array<Interval, 2>> region_at(const Surface& surface, const FractionBox& region);

/// R_ij(u, v) of all control points that affect a point, rows counted from `first`.
[[nodiscard]] std::vector<std::pair<int, double>> basis_terms(const Surface& surface, const std::array<double, 2>& u,
                                                              int first);

}  // namespace knead
