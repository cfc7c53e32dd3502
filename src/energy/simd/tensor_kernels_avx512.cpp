// Compiled for AVX-512 if the compiler can (src/energy/CMakeLists.txt); called only if the machine
// has it.
#ifdef __AVX512F__
#define KNEAD_ISA tensor_avx512
#define KNEAD_LANES 8
#include "tensor_kernels.inc"

namespace knead::detail {
const TensorKernels* const avx512_tensor_kernels = &tensor_avx512::tensor_kernels;
}
#else
#include "tensor_kernels.hpp"

namespace knead::detail {
const TensorKernels* const avx512_tensor_kernels = nullptr;
}
#endif
