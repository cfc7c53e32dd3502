#include "knead/image/image.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace knead {
namespace {

Image discs(double sign) {
  Image image{120, 80, {}};
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 120; ++x) {
      const double a = std::hypot(x - 30, y - 40) < 8 ? 0.6 : 0,
                   b = std::hypot(x - 85, y - 35) < 14 ? 0.2 : 0;
      image.values.push_back(0.5 + sign * (a + b) / 2);
    }
  }
  return image;
}

TEST(Blobs, AreDiscsWithTheirPlaceRadiusAndContrast) {
  for (const bool dark : {false, true}) {
    const auto blobs =
        find_blobs(discs(dark ? -1 : 1), {.radii = {5, 20}, .contrast = 0.05, .dark = dark});
    ASSERT_TRUE(blobs) << blobs.error().message();
    ASSERT_EQ(blobs->size(), 2U);
    const Blob &a = (*blobs)[0], &b = (*blobs)[1];
    EXPECT_LE(std::hypot(a.x - 30, a.y - 40), 1);
    EXPECT_LE(std::hypot(b.x - 85, b.y - 35), 1);
    EXPECT_NEAR(a.radius, 8, 0.15 * 8);  // scales grow by 15 %
    EXPECT_NEAR(b.radius, 14, 0.15 * 14);
    EXPECT_NEAR(a.contrast, 0.3, 0.03);
    EXPECT_NEAR(b.contrast, 0.1, 0.01);
  }
  EXPECT_TRUE(find_blobs(discs(1), {.radii = {5, 20}, .contrast = 0.5})->empty());
}

TEST(Blobs, RefuseWhatMakesNoSense) {
  EXPECT_EQ(find_blobs({}).error().kind, ErrorKind::input);
  EXPECT_EQ(find_blobs(discs(1), {.radii = {5, 4}}).error().where, "radii");
  EXPECT_EQ(find_blobs(discs(1), {.radii = {0, 4}}).error().where, "radii");
  EXPECT_EQ(find_blobs(discs(1), {.contrast = -1}).error().where, "contrast");
}

}  // namespace
}  // namespace knead
