// Compiled for AVX2 if the compiler can (src/solve/CMakeLists.txt); called only if the machine has
// it.
#ifdef __AVX2__
#define KNEAD_ISA panels_avx2
#define KNEAD_LANES 4
#include "panel_kernels.inc"

namespace knead::detail {
const PanelKernels* const avx2_panel_kernels = &panels_avx2::panel_kernels;
}
#else
#include "panel_kernels.hpp"

namespace knead::detail {
const PanelKernels* const avx2_panel_kernels = nullptr;
}
#endif
