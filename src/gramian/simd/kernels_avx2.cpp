// Compiled for AVX2 if the compiler can (src/gramian/CMakeLists.txt); called only if the machine
// has it.
#ifdef __AVX2__
#define KNEAD_ISA isa_avx2
#define KNEAD_LANES 4
#include "kernels.inc"

namespace knead::detail {
const GramianKernels* const avx2_kernels = &isa_avx2::kernels;
}
#else
#include "kernels.hpp"

namespace knead::detail {
const GramianKernels* const avx2_kernels = nullptr;
}
#endif
