#pragma once

#include <cstddef>

namespace knead::detail {

/// Elements of a shell side by side, and how many functions and Gauss points each has per
/// direction. All numbers lie lane by lane: number k of lane l at 4 k + l.
struct ShellBlockShape {
  static constexpr std::ptrdiff_t lanes = 4;
  static constexpr std::ptrdiff_t rest_numbers = 19, quotient_numbers = 6;

  std::ptrdiff_t functions[2], points[2];
  bool rational;

  [[nodiscard]] std::ptrdiff_t local() const { return functions[0] * functions[1]; }
  [[nodiscard]] std::ptrdiff_t gauss() const { return points[0] * points[1]; }
  /// Pairs j <= j' of functions of the second direction, at pair(j, j').
  [[nodiscard]] std::ptrdiff_t pairs() const { return functions[1] * (functions[1] + 1) / 2; }
  [[nodiscard]] std::ptrdiff_t pair(std::ptrdiff_t j, std::ptrdiff_t k) const {
    return j * functions[1] - j * (j - 1) / 2 + k - j;
  }
  /// Numbers that the kernels need to work in.
  [[nodiscard]] std::ptrdiff_t work() const {
    return lanes * (18 * functions[0] * points[1] + 81 * pairs());
  }
};

struct ShellBlockData {
  const double* table[2];  ///< [point][order 0 to 2][function] per direction
  const double* rest;  ///< [point]: weight, metric, curvature, membrane and bending stiffness (00
                       ///< 01 02 11 12 22)
  const double* quotient;  ///< [point]: 1/W and by what p contributes to S_u, S_v, S_uu, S_vv,
                           ///< S_uv; rational only
};

/// The energy of such elements, by sum factorisation, compiled for one instruction set. All give
/// the same bits: the same operations in the same order, nothing fused.
struct ShellKernels {
  /// \param x of the numerator w S: [function][coordinate] \param parts membrane and bending
  /// energy, added to \param force ∂W/∂x likewise, or null \param stress [point][6], or null
  void (*forces)(const ShellBlockShape& shape, const ShellBlockData& data, const double* x,
                 double* work, double* parts, double* force, double* stress);
  /// \param stress [point][6], of the geometric part
  /// \param out [pair(j, j')][i][i'][coordinate][coordinate]: the block of functions (i, j) and
  /// (i', j'); where j = j' those of i <= i' only
  void (*hessian)(const ShellBlockShape& shape, const ShellBlockData& data, const double* x,
                  const double* stress, double* work, double* out);
};

extern const ShellKernels* const vector128_shell_kernels;
extern const ShellKernels* const avx2_shell_kernels;  ///< null if the compiler does not target it

}  // namespace knead::detail
