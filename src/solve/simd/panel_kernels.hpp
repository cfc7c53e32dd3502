#pragma once

#include <cstddef>

namespace knead::detail {

/// Substitution with one panel of a factor (see `Panels`), compiled for one instruction set. All give the same bits:
/// the same operations in the same order, nothing fused.
struct PanelKernels {
  /// \param l the values of the panel \param rows those below it, `count` \param x all unknowns \param own those of the
  ///          panel
  using Down = void (*)(const double* l, const int* rows, std::ptrdiff_t count, double* x, double* own);
  using Up = void (*)(const double* l, const int* rows, std::ptrdiff_t count, const double* x, double* own);

  Down down_one[4], down_four[4];  ///< by width − 1, for one and for four values per unknown
  Up up_one[4], up_four[4];
};

extern const PanelKernels* const vector128_panel_kernels;
extern const PanelKernels* const avx2_panel_kernels;  ///< null if the compiler does not target it

}  // namespace knead::detail
