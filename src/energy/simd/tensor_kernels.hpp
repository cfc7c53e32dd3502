#pragma once

#include <cstddef>

#include "knead/gramian/instruction_set.hpp"

namespace knead::detail {

/// The inner loops of tensor products of band matrices, compiled for one instruction set. All give the same bits: the
/// same operations in the same order, nothing fused.
struct TensorKernels {
  /// y[m] = Σ_k factors[k] x[k · stride + m], 0 <= m < length.
  void (*combine)(const double* x, std::ptrdiff_t stride, const double* factors, std::ptrdiff_t count,
                  std::ptrdiff_t length, double* y);
  /// y[m] += Σ_k diagonals[k · stride + m] x[m + k · shift], 0 <= m < length.
  void (*add_band)(const double* diagonals, std::ptrdiff_t stride, std::ptrdiff_t count, std::ptrdiff_t shift,
                   const double* x, std::ptrdiff_t length, double* y);
  /// For every column of `columns`: to[c] = Σ_g weights[g] band[g · stride + c], 0 <= c < length; the next column's
  /// weights are `kinds` further, its values follow. Writes up to `spare` values too many after the last column.
  void (*write_runs)(const double* band, std::ptrdiff_t stride, const double* weights, std::ptrdiff_t kinds,
                     std::ptrdiff_t columns, std::ptrdiff_t length, double* to);
  static constexpr std::ptrdiff_t spare = 8;  ///< `band` is read as far beyond a run, too
};

extern const TensorKernels* const vector128_tensor_kernels;
extern const TensorKernels* const avx2_tensor_kernels;    ///< null if the compiler does not target it
extern const TensorKernels* const avx512_tensor_kernels;  ///< likewise

/// The fastest that this machine runs, up to those of an instruction set.
[[nodiscard]] const TensorKernels& tensor_kernels(InstructionSet set = best_instruction_set());

}  // namespace knead::detail
