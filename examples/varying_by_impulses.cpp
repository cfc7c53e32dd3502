#include "varying_by_impulses.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

#include "knead/spline/basis.hpp"

namespace knead::examples {
namespace {

/// One derivative of a basis function at a knot: its limits from both sides, 0 outside of the
/// support.
struct Limits {
  double before = 0, after = 0;
  [[nodiscard]] double jump() const { return after - before; }
};

std::vector<Limits> limits_of(const KnotVector& knots, int i, double knot) {
  const int p = knots.degree();
  std::vector<Limits> limits(static_cast<std::size_t>(p + 1));
  for (int r = 0; r <= p; ++r) {
    Limits& l = limits[static_cast<std::size_t>(r)];
    if (knot > knots[i]) l.before = basis_function(knots, i, r, knot, Side::left);
    if (knot < knots[i + p + 1]) l.after = basis_function(knots, i, r, knot, Side::right);
  }
  return limits;
}

double integral_of(const KnotVector& knots, std::span<const double> coefficients, int times,
                   double u) {
  double sum = 0;
  for (int k = 0; k < knots.count(); ++k) {
    sum += coefficients[static_cast<std::size_t>(k)] * basis_integral(knots, k, times, u);
  }
  return sum;
}

}  // namespace

double varying_by_impulses(const KnotVector& knots, int i, int j,
                           const KnotVector& coefficient_knots,
                           std::span<const double> coefficients, StepTimesImpulse reading) {
  assert(knots.clamped() && coefficient_knots.count() == static_cast<int>(coefficients.size()));
  const int p = knots.degree();
  const double begin = std::max(knots[i], knots[j]),
               end = std::min(knots[i + p + 1], knots[j + p + 1]);
  double sum = 0, last = begin - 1;
  for (const double knot : knots.knots()) {
    if (knot < begin || knot > end || knot == last) continue;
    last = knot;
    const std::vector<Limits> first = limits_of(knots, i, knot), second = limits_of(knots, j, knot);
    for (int r = 0; r <= 2 * p; ++r) {
      double jump = 0, binomial = 1;  // C(r, k)
      for (int k = 0; k <= r; binomial = binomial * (r - k) / (k + 1), ++k) {
        if (k > p || r - k > p) continue;
        const Limits &g = first[static_cast<std::size_t>(k)],
                     &h = second[static_cast<std::size_t>(r - k)];
        jump += binomial * (reading == StepTimesImpulse::mean
                                ? g.after * h.after - g.before * h.before
                                : g.jump() * h.after + g.after * h.jump());
      }
      if (jump != 0)
        sum += (r % 2 == 0 ? -1 : 1) * jump *
               integral_of(coefficient_knots, coefficients, r + 1, knot);
    }
  }
  return sum;
}

}  // namespace knead::examples
