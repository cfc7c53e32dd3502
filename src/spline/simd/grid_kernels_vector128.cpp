#define KNEAD_ISA grid_vector128
#define KNEAD_LANES 2
#include "grid_kernels.inc"

namespace knead::detail {
const GridKernels* const vector128_grid_kernels = &grid_vector128::grid_kernels;
}
