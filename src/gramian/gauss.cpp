#include <cmath>

#include "kernel_call.hpp"
#include "methods.hpp"
#include "simd/select.hpp"
#include "span_basis.hpp"
#include "unit_gauss.hpp"

namespace knead::detail {

BandMatrix gauss_gramian(const KnotVector& knots, int a, int b) {
  const int p = knots.degree();
  BandMatrix result(knots.count(), p, symmetry_of(a, b));
  if (a > p || b > p) return result;
  // The integrand has degree 2p − a − b on each span.
  const UnitGaussRule<double> rule = unit_gauss<double>(p + 1);
  const int orders[2] = {a, b};
  SpanValues<double> values[2];
  for (const int span : knots.spans()) {
    const double h = knots[span + 1] - knots[span];
    for (std::size_t g = 0; g < rule.t.size(); ++g) {
      span_basis(knots, span, rule.t[g], rule.complement[g], orders, 2, values);
      const double weight = h * rule.weights[g];
      for (int i = 0; i <= p; ++i) {
        const double factor = weight * values[0][i];
        for (int j = a == b ? i : 0; j <= p; ++j) result.at(span - p + i, span - p + j) += factor * values[1][j];
      }
    }
  }
  return result;
}

GaussPoints gauss_points(int degree) {
  GaussPoints points{};
  const UnitGaussRule<double> rule = unit_gauss<double>(degree + 1);
  for (std::size_t g = 0; g < rule.t.size(); ++g) {
    points.t[g] = rule.t[g];
    points.complement[g] = rule.complement[g];
    points.root_weight[g] = std::sqrt(rule.weights[g]);
  }
  return points;
}

void gauss_gramians(const KnotVector& knots, InstructionSet instructions, GramianSet& set) {
  constexpr int highest_kernel = 7;
  const int p = knots.degree();
  if (p > highest_kernel || !within_kernel_range(knots)) {
    set = {gauss_gramian(knots, 0, 0), gauss_gramian(knots, 1, 1), gauss_gramian(knots, 2, 2),
           gauss_gramian(knots, 1, 0)};
    return;
  }
  resize(set, knots);
  const KernelCall call(knots, set);
  kernels_of(instructions).gauss(call.knots(), p, gauss_points(p), call.output());
  cut_to_domain(knots, set);
}

}  // namespace knead::detail
