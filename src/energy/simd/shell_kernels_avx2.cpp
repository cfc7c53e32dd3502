// Compiled for AVX2 if the compiler can (src/energy/CMakeLists.txt); called only if the machine has
// it.
#ifdef __AVX2__
#define KNEAD_ISA shell_avx2
#define KNEAD_LANES 4
#include "shell_kernels.inc"

namespace knead::detail {
const ShellKernels* const avx2_shell_kernels = &shell_avx2::shell_kernels;
}
#else
#include "shell_kernels.hpp"

namespace knead::detail {
const ShellKernels* const avx2_shell_kernels = nullptr;
}
#endif
