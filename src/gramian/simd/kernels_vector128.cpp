#define KNEAD_ISA isa_vector128
#define KNEAD_LANES 2
#include "kernels.inc"

namespace knead::detail {
const GramianKernels* const vector128_kernels = &isa_vector128::kernels;
}
