#include "operation_count.hpp"

#include "analytic.hpp"
#include "counted.hpp"
#include "gauss.hpp"
#include "kernel_call.hpp"
#include "methods.hpp"

#define KNEAD_COUNTING
#define KNEAD_ISA isa_counting
#define KNEAD_LANES 1
#include "simd/gauss.inc"
#include "simd/gauss_reduced.inc"
#include "simd/kernels.inc"

namespace knead {

OperationCount count_operations(const KnotVector& knots, GramianMethod method) {
  Counted::count() = {};
  if (method == GramianMethod::analytic) {
    for (const auto& [a, b] : {std::pair{0, 0}, {1, 1}, {2, 2}, {1, 0}}) {
      detail::Analytic<Counted>(knots).accumulate(a, b, [](int, int, Counted) {});
      if (a != b) detail::Analytic<Counted>(knots).accumulate(b, a, [](int, int, Counted) {});
    }
  } else if (method == GramianMethod::gauss_reduced && !detail::has_gauss_kernels(knots)) {
    Counted sum = 0;
    for (const auto& [a, b] : {std::pair{0, 0}, {1, 1}, {2, 2}, {1, 0}}) {
      detail::accumulate_gauss<Counted>(knots, a, b,
                                        detail::sufficient_points(knots.degree(), a, b),
                                        [&](int, int, Counted share) { sum += share; });
    }
  } else if (detail::within_kernel_range(knots)) {
    GramianSet set;
    detail::resize(set, knots);
    const detail::KernelCall call(knots, set);
    if (method == GramianMethod::recurrence) {
      detail::isa_counting::kernels.recurrence(call.knots(), knots.degree(), call.output());
    } else if (method == GramianMethod::gauss) {
      detail::isa_counting::kernels.gauss(call.knots(), knots.degree(),
                                          detail::gauss_points(knots.degree() + 1), call.output());
    } else {
      detail::isa_counting::kernels.gauss_reduced(
          call.knots(), knots.degree(), detail::reduced_gauss_points(knots.degree()).data(),
          call.output());
    }
  }
  return Counted::count();
}

}  // namespace knead
