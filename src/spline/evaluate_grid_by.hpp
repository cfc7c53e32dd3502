#pragma once

#include "knead/spline/evaluate.hpp"
#include "simd/grid_kernels.hpp"

namespace knead::detail {

/// `evaluate_grid` by given kernels.
template <int D>
[[nodiscard]] Expected<void> evaluate_grid_by(const GridKernels& kernels, const Spline<D>& spline,
                                              const std::array<const BasisTable*, D>& tables,
                                              int order, Evaluation<D>& result);

}  // namespace knead::detail
