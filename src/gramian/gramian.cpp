#include "knead/gramian/gramian.hpp"

#include <fmt/format.h>

#include <utility>

#include "methods.hpp"

namespace knead {
namespace {

constexpr int max_order = 2;

constexpr GramianMethod methods[] = {GramianMethod::gauss, GramianMethod::analytic, GramianMethod::recurrence};

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
  return usage_error(fmt::format("there is no Gramian method \"{}\"", wanted), {}, "use gauss, analytic or recurrence");
}

std::string_view name(GramianMethod method) {
  switch (method) {
    case GramianMethod::gauss:
      return "gauss";
    case GramianMethod::analytic:
      return "analytic";
    case GramianMethod::recurrence:
      return "recurrence";
  }
  return {};
}

Expected<BandMatrix> gramian(const KnotVector& knots, int a, int b, GramianMethod method) {
  if (a < 0 || a > max_order || b < 0 || b > max_order) {
    return usage_error(fmt::format("there is no Gramian of orders {} and {}", a, b), {},
                       fmt::format("use derivative orders 0 to {}", max_order));
  }
  if (method == GramianMethod::analytic) return detail::analytic_gramian(knots, a, b);
  if (a == b || a + b == 1) return by_kernel(knots, a, b, method);
  return detail::gauss_gramian(knots, a, b);
}

Expected<GramianSet> gramians(const KnotVector& knots, GramianMethod method) {
  GramianSet set;
  recompute_gramians(knots, method, set);
  return set;
}

void recompute_gramians(const KnotVector& knots, GramianMethod method, GramianSet& set, InstructionSet instructions) {
  switch (method) {
    case GramianMethod::gauss:
      return detail::gauss_gramians(knots, instructions, set);
    case GramianMethod::recurrence:
      return detail::recurrence_gramians(knots, instructions, set);
    case GramianMethod::analytic:
      set = {detail::analytic_gramian(knots, 0, 0), detail::analytic_gramian(knots, 1, 1),
             detail::analytic_gramian(knots, 2, 2), detail::analytic_gramian(knots, 1, 0)};
  }
}

}  // namespace knead
