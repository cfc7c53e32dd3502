#define KNEAD_ISA shell_vector128
#define KNEAD_LANES 2
#include "shell_kernels.inc"

namespace knead::detail {
const ShellKernels* const vector128_shell_kernels = &shell_vector128::shell_kernels;
}
