#pragma once

#include <cstddef>

namespace knead::detail {

/// The making of a factor's panels and substitution with them (see `Panels`), compiled for one
/// instruction set. All give the same bits: the same operations in the same order, nothing fused.
struct PanelKernels {
  /// \param l the values of the panel
  /// \param rows those below it, `count`
  /// \param x all unknowns
  /// \param own those of the panel
  using Down = void (*)(const double* l, const int* rows, std::ptrdiff_t count, double* x,
                        double* local);
  using Up = void (*)(const double* l, const int* rows, std::ptrdiff_t count, const double* x,
                      double* local);

  /// Takes the product of one panel with some of its own rows from the rows below a later panel.
  /// \param l the rows of the earlier panel, `count`
  /// \param rows which they are
  /// \param place where each is among those below the later panel, by row; negative: nowhere, there
  /// the product is zero
  /// \param factors by column of the earlier panel and then of the later
  /// \param to the rows below the later panel
  using Update = void (*)(const double* l, const int* rows, std::ptrdiff_t count, const int* place,
                          const double* factors, double* to);

  Update update[4][4];             ///< by width − 1 of the earlier and of the later panel
  Down down_one[4], down_four[4];  ///< by width − 1, for one and for four values per unknown
  Up up_one[4], up_four[4];
};

extern const PanelKernels* const vector128_panel_kernels;
extern const PanelKernels* const avx2_panel_kernels;    ///< null if the compiler does not target it
extern const PanelKernels* const avx512_panel_kernels;  ///< likewise

}  // namespace knead::detail
