// Compiled for AVX2 if the compiler can (src/gramian/CMakeLists.txt); called only if the machine
// has it.
#ifdef __AVX2__
#define KNEAD_ISA piece_avx2
#define KNEAD_LANES 4
#include "piece_kernels.inc"

namespace knead::detail {
const PieceKernels* const avx2_piece_kernels = &piece_avx2::piece_kernels;
}
#else
#include "piece_kernels.hpp"

namespace knead::detail {
const PieceKernels* const avx2_piece_kernels = nullptr;
}
#endif
