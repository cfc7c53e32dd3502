#ifdef __AVX512F__
#define KNEAD_ISA isa_avx512
#define KNEAD_LANES 8
#include "gauss_reduced.inc"
#endif
