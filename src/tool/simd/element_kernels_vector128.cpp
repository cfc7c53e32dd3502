#define KNEAD_ISA element_vector128
#define KNEAD_LANES 2
#include "element_kernels.inc"

namespace knead::detail {
const ElementKernels* const vector128_element_kernels = &element_vector128::element_kernels;
}
