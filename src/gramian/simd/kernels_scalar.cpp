#define KNEAD_ISA isa_scalar
#define KNEAD_LANES 1
#include "kernels.inc"

namespace knead::detail {
const GramianKernels* const scalar_kernels = &isa_scalar::kernels;
}
