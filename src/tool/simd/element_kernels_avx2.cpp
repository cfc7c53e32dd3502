// Compiled for AVX2 if the compiler can (src/sculpt/CMakeLists.txt); called only if the machine has
// it.
#ifdef __AVX2__
#define KNEAD_ISA element_avx2
#define KNEAD_LANES 4
#include "element_kernels.inc"

namespace knead::detail {
const ElementKernels* const avx2_element_kernels = &element_avx2::element_kernels;
}
#else
#include "element_kernels.hpp"

namespace knead::detail {
const ElementKernels* const avx2_element_kernels = nullptr;
}
#endif
