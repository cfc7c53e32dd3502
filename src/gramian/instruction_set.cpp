#include "knead/gramian/instruction_set.hpp"

#include <cstdlib>

#include "simd/kernels.hpp"
#include "simd/select.hpp"

namespace knead {
namespace {

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

const detail::GramianKernels* compiled(InstructionSet set) {
  switch (set) {
    case InstructionSet::scalar:
      return detail::scalar_kernels;
    case InstructionSet::vector128:
      return detail::vector128_kernels;
    case InstructionSet::avx2:
      return detail::avx2_kernels;
    case InstructionSet::avx512:
      return detail::avx512_kernels;
  }
  return nullptr;
}

std::vector<InstructionSet> find_available() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set :
       {InstructionSet::scalar, InstructionSet::vector128, InstructionSet::avx2, InstructionSet::avx512}) {
    if (compiled(set) != nullptr && runs_here(set)) sets.push_back(set);
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

const detail::GramianKernels& detail::kernels_of(InstructionSet set) {
  const GramianKernels* kernels = compiled(set);
  return kernels != nullptr && runs_here(set) ? *kernels : *compiled(available_instruction_sets().front());
}

}  // namespace knead
