#pragma once

#include <array>
#include <span>

#include "constraint.hpp"

namespace knead {

/// The parameters at fractions of the domain. Errors (input): not D numbers, one that is not from 0
/// to 1, named `where`.
template <int D>
[[nodiscard]] Expected<std::array<double, D>> parameters_at(const Spline<D>& spline,
                                                            std::span<const double> at,
                                                            const char* where = "at");

/// (u, v) at fractions of the domain. Error (input): a number that is not from 0 to 1, named
/// `where`.
[[nodiscard]] Expected<std::array<double, 2>> parameters_at(const Surface& surface,
                                                            const Fractions& at,
                                                            const char* where = "at");

/// The size of a surface: the diagonal of the box of its control points.
[[nodiscard]] double net_size(const Surface& surface);

/// The intervals of u and v of a rectangle in fractions. Errors (input): a number that is not from
/// 0 to 1, a side that decreases.
[[nodiscard]] Expected<std::array<Interval, 2>> region_at(const Surface& surface,
                                                          const FractionBox& region);

}  // namespace knead
