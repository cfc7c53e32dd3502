// Compiled for AVX2 if the compiler can (src/spline/CMakeLists.txt); called only if the machine has
// it.
#ifdef __AVX2__
#define KNEAD_ISA grid_avx2
#define KNEAD_LANES 4
#include "grid_kernels.inc"

namespace knead::detail {
const GridKernels* const avx2_grid_kernels = &grid_avx2::grid_kernels;
}
#else
#include "grid_kernels.hpp"

namespace knead::detail {
const GridKernels* const avx2_grid_kernels = nullptr;
}
#endif
