#include "knead/gramian/gramian.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "methods.hpp"

namespace knead {
namespace {

constexpr GramianMethod methods[] = {GramianMethod::gauss, GramianMethod::gauss_reduced,
                                     GramianMethod::analytic, GramianMethod::recurrence};

/// One of 00, 11, 22, 10 and 01.
bool is_kernel_term(int a, int b) { return (a == b && a <= 2) || a + b == 1; }

/// One of the four terms that the kernels compute together.
BandMatrix by_kernel(const KnotVector& knots, int a, int b, GramianMethod method) {
  GramianSet set;
  recompute_gramians(knots, method, set);
  if (a != b) return b == 0 ? std::move(set.g10) : set.g10.transposed();
  return a == 0 ? std::move(set.g00) : a == 1 ? std::move(set.g11) : std::move(set.g22);
}

}  // namespace

Expected<GramianMethod> gramian_method(std::string_view wanted) {
  for (const GramianMethod method : methods) {
    if (name(method) == wanted) return method;
  }
  return usage_error(fmt::format("there is no Gramian method \"{}\"", wanted), {},
                     "use gauss, gauss-reduced, analytic or recurrence");
}

std::string_view name(GramianMethod method) {
  switch (method) {
    case GramianMethod::gauss:
      return "gauss";
    case GramianMethod::gauss_reduced:
      return "gauss-reduced";
    case GramianMethod::analytic:
      return "analytic";
    case GramianMethod::recurrence:
      return "recurrence";
  }
  return {};
}

GramianMethod used_gramian_method(const KnotVector& knots, int a, int b, GramianMethod wanted) {
  const bool other = wanted == GramianMethod::recurrence &&
                     !(is_kernel_term(a, b) && detail::within_kernel_range(knots));
  return other ? GramianMethod::gauss : wanted;
}

Expected<BandMatrix> gramian(const KnotVector& knots, int a, int b, GramianMethod method) {
  if (a < 0 || a > max_degree || b < 0 || b > max_degree) {
    return usage_error(fmt::format("there is no Gramian of orders {} and {}", a, b), {},
                       fmt::format("use derivative orders 0 to {}", max_degree));
  }
  const int full = knots.degree() + 1;
  switch (used_gramian_method(knots, a, b, method)) {
    case GramianMethod::analytic:
      return detail::analytic_gramian(knots, a, b);
    case GramianMethod::gauss_reduced:
      return is_kernel_term(a, b) && detail::has_gauss_kernels(knots)
                 ? by_kernel(knots, a, b, method)
                 : detail::gauss_gramian(knots, a, b,
                                         detail::sufficient_points(knots.degree(), a, b));
    case GramianMethod::gauss:
      return is_kernel_term(a, b) ? by_kernel(knots, a, b, method)
                                  : detail::gauss_gramian(knots, a, b, full);
    case GramianMethod::recurrence:
      return by_kernel(knots, a, b, method);
  }
  return {};
}

Expected<double> digits_left(const KnotVector& knots, int a, int b, const BandMatrix& computed) {
  const auto exact = gramian(knots, a, b, GramianMethod::recurrence);
  if (!exact) return std::unexpected(exact.error());
  double largest = 0, difference = 0;
  for (int i = 0; i < exact->size(); ++i) {
    const int p = knots.degree();
    for (int j = std::max(0, i - p); j <= std::min(exact->size() - 1, i + p); ++j) {
      largest = std::max(largest, std::abs((*exact)(i, j)));
      difference = std::max(difference, std::abs(computed(i, j) - (*exact)(i, j)));
    }
  }
  return difference == 0 ? 17 : std::min(17.0, -std::log10(difference / largest));
}

Expected<GramianSet> gramians(const KnotVector& knots, GramianMethod method) {
  GramianSet set;
  recompute_gramians(knots, method, set);
  return set;
}

void recompute_gramians(const KnotVector& knots, GramianMethod method, GramianSet& set,
                        InstructionSet instructions) {
  switch (method) {
    case GramianMethod::gauss:
      return detail::gauss_gramians(knots, instructions, set);
    case GramianMethod::gauss_reduced:
      return detail::reduced_gauss_gramians(knots, instructions, set);
    case GramianMethod::recurrence:
      return detail::recurrence_gramians(knots, instructions, set);
    case GramianMethod::analytic:
      set = {detail::analytic_gramian(knots, 0, 0), detail::analytic_gramian(knots, 1, 1),
             detail::analytic_gramian(knots, 2, 2), detail::analytic_gramian(knots, 1, 0)};
  }
}

}  // namespace knead
