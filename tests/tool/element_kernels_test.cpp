#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tool/simd/element_kernels.hpp"

namespace knead {
namespace {

using detail::ElementKernels;
using detail::ToolReach;

constexpr auto most = static_cast<std::size_t>(ElementKernels::most_points);

std::vector<double> random_numbers(std::size_t count, unsigned seed, double from = -1,
                                   double to = 1) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> number(from, to);
  std::vector<double> result(count);
  for (double& r : result) r = number(engine);
  return result;
}

/// Control points of an element of so many functions per direction, and tables.
struct Data {
  std::size_t functions, components;
  std::size_t size = static_cast<std::size_t>(
      ElementKernels::rounded_up(static_cast<std::ptrdiff_t>(components * functions)));
  std::size_t stride = 12;
  std::vector<double> factors = random_numbers(functions, 1),
                      controls = random_numbers(functions * size, 2, 0.5, 1),
                      line = random_numbers(size, 3, 0.5, 1),
                      basis = random_numbers(functions * stride, 4, 0.5, 1);
};

const ToolReach reach{{0.2, 0.1, 0.3}, {0.8, 0.7, 0.9}, {0.5, 0.5, 0.5}, 0.09};

std::vector<const ElementKernels*> sets_of_this_machine() {
  std::vector<const ElementKernels*> sets = {detail::vector128_element_kernels};
  if (detail::avx2_element_kernels != nullptr && best_instruction_set() >= InstructionSet::avx2)
    sets.push_back(detail::avx2_element_kernels);
  return sets;
}

/// All that the kernels give, one after the other.
std::vector<double> results_of(const ElementKernels& kernels, const Data& data) {
  const auto count = static_cast<std::ptrdiff_t>(data.functions),
             size = static_cast<std::ptrdiff_t>(data.size);
  std::vector<double> combined(data.size), spread = data.controls, lower(data.size),
                                           upper(data.size), places(4 * most);
  kernels.combine(data.factors.data(), count, data.controls.data(), size, combined.data());
  kernels.spread(data.factors.data(), count, data.line.data(), size, spread.data());
  kernels.bounds(data.controls.data(), count, size, lower.data(), upper.data());
  kernels.places(data.line.data(), data.components == 4, count, data.basis.data(),
                 static_cast<std::ptrdiff_t>(data.stride), ElementKernels::most_points,
                 places.data());
  std::vector<double> all = {
      static_cast<double>(kernels.reached(places.data(), ElementKernels::most_points, reach))};
  for (const auto& part : {combined, spread, lower, upper, places})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// The same by their definitions.
std::vector<double> expected_of(const Data& data) {
  const std::size_t n = data.functions, size = data.size;
  std::vector<double> combined(size), spread = data.controls, lower(size), upper(size),
                                      places(4 * most);
  for (std::size_t m = 0; m < size; ++m) {
    lower[m] = upper[m] = data.controls[m];
    for (std::size_t i = 0; i < n; ++i) {
      const double x = data.controls[i * size + m];
      combined[m] = i == 0 ? data.factors[0] * x : combined[m] + data.factors[i] * x;
      spread[i * size + m] += data.factors[i] * data.line[m];
      lower[m] = std::min(lower[m], x);
      upper[m] = std::max(upper[m], x);
    }
  }
  unsigned reached = 0;
  for (std::size_t g = 0; g < most; ++g) {
    for (std::size_t c = 0; c < data.components; ++c) {
      for (std::size_t j = 0; j < n; ++j) {
        const double term = data.line[c * n + j] * data.basis[j * data.stride + g];
        places[c * most + g] = j == 0 ? term : places[c * most + g] + term;
      }
    }
    if (data.components == 4) places[3 * most + g] = 1 / places[3 * most + g];
    bool inside = true;
    double squared = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      if (data.components == 4) places[c * most + g] *= places[3 * most + g];
      const double x = places[c * most + g], away = x - reach.centre[c];
      inside = inside && x >= reach.lower[c] && x <= reach.upper[c];
      squared += away * away;
    }
    if (inside && squared <= reach.squared_radius) reached |= 1U << g;
  }
  std::vector<double> all = {static_cast<double>(reached)};
  for (const auto& part : {combined, spread, lower, upper, places})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(ElementKernels, GiveTheSameBitsInAllInstructionSetsAsTheirDefinitions) {
  for (const std::size_t functions : {1U, 2U, 3U, 4U, 5U, 6U, 10U}) {
    for (const std::size_t components : {3U, 4U}) {
      const Data data{functions, components};
      const std::vector<double> expected = expected_of(data);
      for (const ElementKernels* kernels : sets_of_this_machine())
        EXPECT_EQ(results_of(*kernels, data), expected);
    }
  }
}

TEST(ElementKernels, ReachPlacesOnTheEdgeAndWhatIsNotANumber) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  // Coordinate by coordinate: inside, on the edge, beside the box, beside the ball, not a number
  // thrice, far away.
  const double places[3 * most] = {0, 1,    1.5, 0.9, nan, 0,   0,   infinity,  //
                                   0, 0,    0,   0.9, 0,   nan, 0,   0,         //
                                   0, -0.0, 0,   0.9, 0,   0,   nan, 0};
  const ToolReach ball{{-1, -1, -1}, {1, 1, 1}, {0, 0, 0}, 1};
  const ToolReach everything{
      {-infinity, -infinity, -infinity}, {infinity, infinity, infinity}, {0, 0, 0}, infinity};
  for (const ElementKernels* kernels : sets_of_this_machine()) {
    EXPECT_EQ(kernels->reached(places, ElementKernels::most_points, ball), 0b01110011U);
    EXPECT_EQ(kernels->reached(places, ElementKernels::step, ball), 0b0011U);
    EXPECT_EQ(kernels->reached(places, ElementKernels::most_points, everything), 0b11111111U);
  }
}

}  // namespace
}  // namespace knead
