// The lowest frequencies of a simply supported plate from K and M (docs/plate.md).
#include "plate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>

int main() try {
  using namespace knead::examples;
  constexpr int count = 10;
  const auto exact = exact_plate_frequencies(count);
  for (int degree : {2, 3, 4, 5}) {
    fmt::print(
        "degree {}: relative error of the lowest {} frequencies, order from the spans before\n",
        degree, count);
    std::vector<double> before;
    for (int spans : {8, 16, 32}) {
      const auto found = plate_frequencies(degree, spans, count);
      if (!found) {
        fmt::print(stderr, "{}\n", found.error().message());
        return 1;
      }
      std::vector<double> errors;
      fmt::print("{:4}", spans);
      for (std::size_t i = 0; i < count; ++i) {
        errors.push_back((*found)[i] / exact[i] - 1);
        fmt::print("  {:8.1e}", errors.back());
        // Below 1e-9 rounding has a share in the error.
        if (!before.empty() && errors.back() > 1e-9)
          fmt::print(" {:4.2f}", std::log2(before[i] / errors.back()));
      }
      fmt::print("\n");
      before = errors;
    }
  }
  return 0;
} catch (const std::exception& e) {
  std::fputs(e.what(), stderr);
  return 1;
}
