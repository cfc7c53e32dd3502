#define KNEAD_ISA piece_vector128
#define KNEAD_LANES 2
#include "piece_kernels.inc"

namespace knead::detail {
const PieceKernels* const vector128_piece_kernels = &piece_vector128::piece_kernels;
}
