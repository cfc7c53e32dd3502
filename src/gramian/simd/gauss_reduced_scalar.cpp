#if !defined(KNEAD_SCALAR_KERNELS) || KNEAD_SCALAR_KERNELS
#define KNEAD_ISA isa_scalar
#define KNEAD_LANES 1
#include "gauss_reduced.inc"
#endif
