// Compiled for AVX-512 if the compiler can (src/gramian/CMakeLists.txt); called only if the machine
// has it.
#ifdef __AVX512F__
#define KNEAD_ISA isa_avx512
#define KNEAD_LANES 8
#include "kernels.inc"

namespace knead::detail {
const GramianKernels* const avx512_kernels = &isa_avx512::kernels;
}
#else
#include "kernels.hpp"

namespace knead::detail {
const GramianKernels* const avx512_kernels = nullptr;
}
#endif
