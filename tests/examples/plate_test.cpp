#include "plate.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace knead::examples {
namespace {

constexpr int count = 10;

// In double precision the small eigenvalues of K x = ω² M x carry the rounding of the largest,
// about 16 · 12 / h⁴ for cubics: 64 ulp of it, which halves from ω² to ω.
double rounding(int spans, double frequency) {
  return 64 * 1.1e-16 * 200 * std::pow(spans, 4) / (frequency * frequency);
}

TEST(PlateFrequencies, LieBetweenThePlateAndTheClosedFormOfASmallerSpace) {
  // Rayleigh and Ritz: a subspace of all deflections has higher frequencies, a subspace of that
  // higher ones yet.
  const auto exact = exact_plate_frequencies(count);
  for (int spans : {8, 16, 24}) {
    const auto found = plate_frequencies(3, spans, count);
    ASSERT_TRUE(found) << found.error().message();
    const auto bound = bounding_plate_frequencies(spans, count);
    for (std::size_t k = 0; k < count; ++k) {
      const double slack = rounding(spans, exact[k]);
      EXPECT_GE((*found)[k], exact[k] * (1 - slack)) << spans << " spans, frequency " << k;
      EXPECT_LE((*found)[k], bound[k] * (1 + slack)) << spans << " spans, frequency " << k;
    }
  }
}

TEST(PlateFrequencies, TheBoundIsNarrowAndOfFourthOrder) {
  // (a⁸ + b⁸) h⁴ / (1440 (a² + b²)²), a = mπ, b = nπ, is its leading term (docs/plate.md); at (1,
  // 1): π⁴ h⁴ / 2880.
  const double pi4 = std::pow(M_PI, 4);
  for (int spans : {16, 32, 64}) {
    const double relative =
        bounding_plate_frequencies(spans, 1)[0] / exact_plate_frequencies(1)[0] - 1;
    EXPECT_NEAR(relative / (pi4 / 2880 / std::pow(spans, 4)), 1, 10.0 / (spans * spans));
  }
  const auto exact = exact_plate_frequencies(count), bound = bounding_plate_frequencies(24, count);
  for (std::size_t k = 0; k < count; ++k) EXPECT_LT(bound[k] / exact[k] - 1, 5e-5);
}

TEST(PlateFrequencies, ConvergeAtTwiceTheDegreeLessTwo) {
  const auto exact = exact_plate_frequencies(3);
  for (int degree : {2, 3, 4}) {
    const auto coarse = plate_frequencies(degree, 8, 3), fine = plate_frequencies(degree, 16, 3);
    ASSERT_TRUE(coarse && fine);
    for (std::size_t k = 0; k < 3; ++k) {
      const double order = std::log2(((*coarse)[k] / exact[k] - 1) / ((*fine)[k] / exact[k] - 1));
      EXPECT_NEAR(order, 2 * (degree - 1), 0.25) << "degree " << degree << ", frequency " << k;
    }
  }
}

TEST(PlateFrequencies, NeedBending) { EXPECT_FALSE(plate_frequencies(1, 8, 3)); }

}  // namespace
}  // namespace knead::examples
