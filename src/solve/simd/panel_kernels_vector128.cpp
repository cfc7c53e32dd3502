#define KNEAD_ISA panels_vector128
#define KNEAD_LANES 2
#include "panel_kernels.inc"

namespace knead::detail {
const PanelKernels* const vector128_panel_kernels = &panels_vector128::panel_kernels;
}
