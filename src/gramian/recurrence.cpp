#include "kernel_call.hpp"
#include "methods.hpp"
#include "simd/select.hpp"

namespace knead::detail {

void recurrence_gramians(const KnotVector& knots, InstructionSet instructions, GramianSet& set) {
  if (!within_kernel_range(knots)) return gauss_gramians(knots, instructions, set);
  resize(set, knots);
  const KernelCall call(knots, set);
  kernels_of(instructions).recurrence(call.knots(), knots.degree(), call.output());
  cut_to_domain(knots, set);
}

}  // namespace knead::detail
