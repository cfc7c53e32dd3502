// Omitted (KNEAD_SCALAR_KERNELS=0) where only vectors are ever used: in WebAssembly.
#if !defined(KNEAD_SCALAR_KERNELS) || KNEAD_SCALAR_KERNELS
#define KNEAD_ISA isa_scalar
#define KNEAD_LANES 1
#include "kernels.inc"

namespace knead::detail {
const GramianKernels* const scalar_kernels = &isa_scalar::kernels;
}
#else
#include "kernels.hpp"

namespace knead::detail {
const GramianKernels* const scalar_kernels = nullptr;
}
#endif
