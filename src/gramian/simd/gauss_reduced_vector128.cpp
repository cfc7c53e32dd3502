#define KNEAD_ISA isa_vector128
#define KNEAD_LANES 2
#include "gauss_reduced.inc"
