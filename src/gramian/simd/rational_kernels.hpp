#pragma once

#include <cstddef>

#include "knead/base/instruction_set.hpp"

namespace knead::detail {

/// The inner loops of rational functions at lines of points, compiled for one instruction set. All
/// give the same bits: the same operations in the same order, nothing fused. Lines have a multiple
/// of `line_step` points.
struct RationalKernels {
  static constexpr std::ptrdiff_t line_step = 4;

  /// to[(i width + s) n + g] = factors[i width + s] last[s n + g] for i width + s < functions, and
  /// sum[g] their sum.
  void (*numerators)(const double* last, const double* factors, std::ptrdiff_t width,
                     std::ptrdiff_t functions, std::ptrdiff_t n, double* to, double* sum);
  /// to[r n + g] −= factor[g] rest[r n + g].
  void (*subtract)(const double* factor, const double* rest, std::ptrdiff_t functions,
                   std::ptrdiff_t n, double* to);
  /// to[r stride + g] = factor[g] from[r n + g]; in place if stride is n.
  void (*scale)(const double* factor, const double* from, std::ptrdiff_t functions,
                std::ptrdiff_t n, std::ptrdiff_t stride, double* to);
  /// block[r + c functions] += Σ_k left[r stride + k] right[c stride + k], c <= r, 0 <= k < rows:
  /// each sum as four, of every fourth product.
  void (*lower_products)(const double* left, const double* right, std::ptrdiff_t stride,
                         std::ptrdiff_t rows, std::ptrdiff_t functions, double* block);
};

extern const RationalKernels* const vector128_rational_kernels;
extern const RationalKernels* const
    avx2_rational_kernels;  ///< null if the compiler does not target it

/// The fastest that this machine runs, up to those of an instruction set.
[[nodiscard]] const RationalKernels& rational_kernels(InstructionSet set = best_instruction_set());

}  // namespace knead::detail
