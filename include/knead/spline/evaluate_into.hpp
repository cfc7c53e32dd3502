#pragma once

#include <span>

#include "knead/spline/evaluate.hpp"

namespace knead {

/// Memory of the caller for an evaluation of N points: one part for each of `multi_indices<D>(order)`, 3 N numbers, x,
/// y, z point after point; parts do not overlap. Requires: as many parts, of this size (asserted).
using DerivativeMemory = std::span<const std::span<double>>;

/// `evaluate` into memory of the caller, with nothing copied: for bases that were tabulated before (to `order` at
/// least), point k is row k of every table, all of one size. After a failure the content is unspecified. Errors: a
/// denominator that is not positive (numerical).
template <int D>
[[nodiscard]] Expected<void> evaluate_into(const Spline<D>& spline, const std::array<const BasisTable*, D>& tables,
                                           int order, DerivativeMemory out);

/// `evaluate_grid` into memory of the caller, likewise.
template <int D>
[[nodiscard]] Expected<void> evaluate_grid_into(const Spline<D>& spline, const std::array<const BasisTable*, D>& tables,
                                                int order, DerivativeMemory out);

}  // namespace knead
