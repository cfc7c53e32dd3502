#include "knead/gramian/gramian.hpp"

#include <fmt/format.h>

#include "methods.hpp"

namespace knead {
namespace {

constexpr int max_order = 2;

BandMatrix compute(const KnotVector& knots, int a, int b, GramianMethod method) {
  switch (method) {
    case GramianMethod::gauss:
      return detail::gauss_gramian(knots, a, b);
    case GramianMethod::analytic:
      return detail::analytic_gramian(knots, a, b);
  }
  return BandMatrix();
}

}  // namespace

Expected<GramianMethod> gramian_method(std::string_view wanted) {
  for (const GramianMethod method : {GramianMethod::gauss, GramianMethod::analytic}) {
    if (name(method) == wanted) return method;
  }
  return usage_error(fmt::format("there is no Gramian method \"{}\"", wanted), {}, "use gauss or analytic");
}

std::string_view name(GramianMethod method) {
  switch (method) {
    case GramianMethod::gauss:
      return "gauss";
    case GramianMethod::analytic:
      return "analytic";
  }
  return {};
}

Expected<BandMatrix> gramian(const KnotVector& knots, int a, int b, GramianMethod method) {
  if (a < 0 || a > max_order || b < 0 || b > max_order) {
    return usage_error(fmt::format("there is no Gramian of orders {} and {}", a, b), {},
                       fmt::format("use derivative orders 0 to {}", max_order));
  }
  return compute(knots, a, b, method);
}

Expected<GramianSet> gramians(const KnotVector& knots, GramianMethod method) {
  return GramianSet{compute(knots, 0, 0, method), compute(knots, 1, 1, method), compute(knots, 2, 2, method),
                    compute(knots, 1, 0, method)};
}

}  // namespace knead
