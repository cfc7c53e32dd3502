// Compiled for AVX-512 if the compiler can (src/spline/CMakeLists.txt); called only if the machine
// has it.
#ifdef __AVX512F__
#define KNEAD_ISA grid_avx512
#define KNEAD_LANES 8
#include "grid_kernels.inc"

namespace knead::detail {
const GridKernels* const avx512_grid_kernels = &grid_avx512::grid_kernels;
}
#else
#include "grid_kernels.hpp"

namespace knead::detail {
const GridKernels* const avx512_grid_kernels = nullptr;
}
#endif
