#pragma once

#include "kernels.hpp"
#include "knead/base/instruction_set.hpp"

namespace knead::detail {

/// The kernels of an instruction set, or the simplest available, usually scalar ones, if the
/// machine lacks it.
[[nodiscard]] const GramianKernels& kernels_of(InstructionSet set);

}  // namespace knead::detail
