#ifdef __AVX2__
#define KNEAD_ISA isa_avx2
#define KNEAD_LANES 4
#include "gauss_reduced.inc"
#endif
