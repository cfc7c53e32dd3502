#define KNEAD_ISA tensor_vector128
#define KNEAD_LANES 2
#include "tensor_kernels.inc"

namespace knead::detail {
const TensorKernels* const vector128_tensor_kernels = &tensor_vector128::tensor_kernels;
}
