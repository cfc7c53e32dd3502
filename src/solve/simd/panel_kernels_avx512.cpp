// Compiled for AVX-512 if the compiler can (src/solve/CMakeLists.txt); called only if the machine
// has it.
#ifdef __AVX512F__
#define KNEAD_ISA panels_avx512
#define KNEAD_LANES 8
#include "panel_kernels.inc"

namespace knead::detail {
const PanelKernels* const avx512_panel_kernels = &panels_avx512::panel_kernels;
}
#else
#include "panel_kernels.hpp"

namespace knead::detail {
const PanelKernels* const avx512_panel_kernels = nullptr;
}
#endif
