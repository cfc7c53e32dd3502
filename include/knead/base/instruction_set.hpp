#pragma once

#include <string_view>
#include <vector>

namespace knead {

/// Instruction sets that kernels are compiled for, each from one source; a room has them for some
/// or all of these and takes the fastest up to the one that is asked for. They differ only in
/// speed: all compute the same numbers bit for bit (the same operations in the same order,
/// divisions correctly rounded, nothing fused).
enum class InstructionSet {
  scalar,     ///< one number at a time, Gramians only; everywhere
  vector128,  ///< two numbers: SSE2, NEON or WebAssembly SIMD, whatever the compiler's baseline
              ///< offers
  avx2,       ///< four numbers, x86 with AVX2
  avx512,     ///< eight numbers, x86 with AVX-512 F, DQ and VL
};

[[nodiscard]] std::string_view name(InstructionSet set);

/// Those that this build contains and this machine can run, slowest first; never empty.
[[nodiscard]] const std::vector<InstructionSet>& available_instruction_sets();

/// The default of all kernels: the fastest available one, or the available one that the environment
/// variable KNEAD_INSTRUCTION_SET names when it is first asked for. For measurements: results do
/// not depend on it.
[[nodiscard]] InstructionSet best_instruction_set();

}  // namespace knead
