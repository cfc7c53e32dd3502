#define KNEAD_ISA rational_vector128
#include "rational_kernels.inc"

namespace knead::detail {
const RationalKernels* const vector128_rational_kernels = &rational_vector128::rational_kernels;
}
