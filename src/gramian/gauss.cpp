#include "gauss.hpp"

#include <cmath>

#include "kernel_call.hpp"
#include "methods.hpp"
#include "simd/select.hpp"
#include "unit_gauss.hpp"

namespace knead::detail {

BandMatrix gauss_gramian(const KnotVector& knots, int a, int b, int points) {
  BandMatrix result(knots.count(), knots.degree(), symmetry_of(a, b));
  accumulate_gauss<double>(knots, a, b, points,
                           [&](int i, int j, double value) { result.at(i, j) += value; });
  return result;
}

bool has_gauss_kernels(const KnotVector& knots) {
  constexpr int highest_kernel = 7;
  return knots.degree() <= highest_kernel && within_kernel_range(knots);
}

GaussPoints gauss_points(int count) {
  GaussPoints points{};
  if (count == 0) return points;
  const UnitGaussRule<double> rule = unit_gauss<double>(count);
  for (std::size_t g = 0; g < rule.t.size(); ++g) {
    points.t[g] = rule.t[g];
    points.complement[g] = rule.complement[g];
    points.root_weight[g] = std::sqrt(rule.weights[g]);
  }
  return points;
}

std::array<GaussPoints, 3> reduced_gauss_points(int degree) {
  return {gauss_points(degree + 1), gauss_points(degree), gauss_points(degree - 1)};
}

void gauss_gramians(const KnotVector& knots, InstructionSet instructions, GramianSet& set) {
  const int p = knots.degree();
  if (!has_gauss_kernels(knots)) {
    const auto term = [&](int a, int b) { return gauss_gramian(knots, a, b, p + 1); };
    set = {term(0, 0), term(1, 1), term(2, 2), term(1, 0)};
    return;
  }
  resize(set, knots);
  const KernelCall call(knots, set);
  kernels_of(instructions).gauss(call.knots(), p, gauss_points(p + 1), call.output());
  cut_to_domain(knots, set);
}

void reduced_gauss_gramians(const KnotVector& knots, InstructionSet instructions, GramianSet& set) {
  const int p = knots.degree();
  if (!has_gauss_kernels(knots)) {
    const auto term = [&](int a, int b) {
      return gauss_gramian(knots, a, b, sufficient_points(p, a, b));
    };
    set = {term(0, 0), term(1, 1), term(2, 2), term(1, 0)};
    return;
  }
  resize(set, knots);
  const KernelCall call(knots, set);
  kernels_of(instructions)
      .gauss_reduced(call.knots(), p, reduced_gauss_points(p).data(), call.output());
  cut_to_domain(knots, set);
}

}  // namespace knead::detail
