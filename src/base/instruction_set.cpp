#include "knead/base/instruction_set.hpp"

#include <cstdlib>

namespace knead {
namespace {

// AVX2 without FMA, and no set's kernels fuse: a fused product has other bits, and all sets must
// give the same.
bool runs_here(InstructionSet set) {
#if defined(__x86_64__) || defined(__i386__)
  switch (set) {
    case InstructionSet::avx2:
      return __builtin_cpu_supports("avx2");
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512vl");
    default:
      return true;
  }
#else
  return set == InstructionSet::scalar || set == InstructionSet::vector128;
#endif
}

/// Omitted (KNEAD_SCALAR_KERNELS=0) where only vectors are ever used: in WebAssembly.
bool compiled([[maybe_unused]] InstructionSet set) {
#if defined(KNEAD_SCALAR_KERNELS) && !KNEAD_SCALAR_KERNELS
  return set != InstructionSet::scalar;
#else
  return true;
#endif
}

std::vector<InstructionSet> find_available() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : {InstructionSet::scalar, InstructionSet::vector128,
                                   InstructionSet::avx2, InstructionSet::avx512}) {
    if (compiled(set) && runs_here(set)) sets.push_back(set);
  }
  return sets;
}

InstructionSet find_best() {
  const std::vector<InstructionSet>& sets = available_instruction_sets();
#ifndef __wasm__  // a module has no environment, and one set
  if (const char* wanted = std::getenv("KNEAD_INSTRUCTION_SET")) {
    for (const InstructionSet set : sets) {
      if (name(set) == wanted) return set;
    }
  }
#endif
  return sets.back();
}

}  // namespace

std::string_view name(InstructionSet set) {
  switch (set) {
    case InstructionSet::scalar:
      return "scalar";
    case InstructionSet::vector128:
      return "vector128";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::avx512:
      return "avx512";
  }
  return {};
}

const std::vector<InstructionSet>& available_instruction_sets() {
  static const std::vector<InstructionSet> sets = find_available();
  return sets;
}

InstructionSet best_instruction_set() {
  static const InstructionSet best = find_best();
  return best;
}

}  // namespace knead
