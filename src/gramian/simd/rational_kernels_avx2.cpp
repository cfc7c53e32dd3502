// Compiled for AVX2 if the compiler can (src/gramian/CMakeLists.txt); called only if the machine
// has it.
#ifdef __AVX2__
#define KNEAD_ISA rational_avx2
#include "rational_kernels.inc"

namespace knead::detail {
const RationalKernels* const avx2_rational_kernels = &rational_avx2::rational_kernels;
}
#else
#include "rational_kernels.hpp"

namespace knead::detail {
const RationalKernels* const avx2_rational_kernels = nullptr;
}
#endif
