// Compiled for AVX2 if the compiler can (src/energy/CMakeLists.txt); called only if the machine has
// it.
#ifdef __AVX2__
#define KNEAD_ISA tensor_avx2
#define KNEAD_LANES 4
#include "tensor_kernels.inc"

namespace knead::detail {
const TensorKernels* const avx2_tensor_kernels = &tensor_avx2::tensor_kernels;
}
#else
#include "tensor_kernels.hpp"

namespace knead::detail {
const TensorKernels* const avx2_tensor_kernels = nullptr;
}
#endif
