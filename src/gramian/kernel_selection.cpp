#include <algorithm>

#include "simd/select.hpp"

namespace knead::detail {
namespace {

const GramianKernels* compiled_kernels(InstructionSet set) {
  switch (set) {
    case InstructionSet::scalar:
      return scalar_kernels;
    case InstructionSet::vector128:
      return vector128_kernels;
    case InstructionSet::avx2:
      return avx2_kernels;
    case InstructionSet::avx512:
      return avx512_kernels;
  }
  return nullptr;
}

}  // namespace

const GramianKernels& kernels_of(InstructionSet set) {
  const auto& sets = available_instruction_sets();
  return *compiled_kernels(std::ranges::find(sets, set) != sets.end() ? set : sets.front());
}

}  // namespace knead::detail
