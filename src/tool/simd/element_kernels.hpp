#pragma once

#include <cstddef>

#include "knead/base/instruction_set.hpp"

namespace knead::detail {

/// Where a tool may act: in a box, and in a ball, which may be infinitely large.
struct ToolReach {
  double lower[3], upper[3], centre[3], squared_radius;
};

/// The inner loops of sums between the control points of an element and its Gauss points, compiled
/// for one instruction set. All give the same bits: the same operations in the same order, nothing
/// fused. Lines lie coordinate by coordinate; numbers of a line, and points, are rounded up to
/// multiples of `step`.
struct ElementKernels {
  static constexpr std::ptrdiff_t step = 4, most_points = 8;
  [[nodiscard]] static constexpr std::ptrdiff_t rounded_up(std::ptrdiff_t n) {
    return (n + step - 1) / step * step;
  }

  /// to[m] = Σ_i factors[i] from[i size + m] for i < count, m < size.
  void (*combine)(const double* factors, std::ptrdiff_t count, const double* from,
                  std::ptrdiff_t size, double* to);
  /// to[i size + m] += factors[i] from[m] for i < count, m < size.
  void (*spread)(const double* factors, std::ptrdiff_t count, const double* from,
                 std::ptrdiff_t size, double* to);
  /// lower[m] and upper[m] of from[i size + m] over i < count, for m < size.
  void (*bounds)(const double* from, std::ptrdiff_t count, std::ptrdiff_t size, double* lower,
                 double* upper);
  /// to[c most_points + g] = Σ_j line[c functions + j] basis[j stride + g] for g < points <=
  /// most_points; where the line has four coordinates, the last is the denominator: its inverse is
  /// stored, and the others are multiplied by that.
  void (*places)(const double* line, bool rational, std::ptrdiff_t functions, const double* basis,
                 std::ptrdiff_t stride, std::ptrdiff_t points, double* to);
  /// Bit g: place g, as `places` stores them, is not outside. What is not a number is not outside.
  unsigned (*reached)(const double* places, std::ptrdiff_t points, const ToolReach& reach);
};

extern const ElementKernels* const vector128_element_kernels;
extern const ElementKernels* const
    avx2_element_kernels;  ///< null if the compiler does not target it

/// The fastest that this machine runs, up to those of an instruction set.
[[nodiscard]] const ElementKernels& element_kernels(InstructionSet set = best_instruction_set());

}  // namespace knead::detail
