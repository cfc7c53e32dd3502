#include "rational_pairs.hpp"

#include <fmt/format.h>

#include <cmath>

namespace knead::detail {

Expected<void> check_rational(std::span<const double> weights, int count, std::array<int, 2> a,
                              std::array<int, 2> b, double tolerance) {
  for (const std::array<int, 2> order : {a, b}) {
    if (order[0] < 0 || order[1] < 0 || order[0] + order[1] > rational_order) {
      return usage_error(
          fmt::format("there is no rational Gramian of order {} {}", order[0], order[1]), {},
          "use total orders 0 to 2");
    }
  }
  if (!(tolerance > 0))
    return usage_error("the tolerance is not positive", {}, "use a fraction such as 1e-10");
  if (static_cast<int>(weights.size()) != count) {
    return input_error(fmt::format("there are {} weights for {} functions", weights.size(), count),
                       "weights", "give one weight for each function");
  }
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (!(weights[k] > 0) || !std::isfinite(weights[k])) {
      return input_error("the weight is not a positive number", fmt::format("weight {}", k),
                         "use positive weights");
    }
  }
  return {};
}

std::unexpected<Error> no_lower_bound() {
  return numerical_error("the rational denominator has no positive lower bound", "rational Gramian",
                         "use weights that differ less");
}

}  // namespace knead::detail
